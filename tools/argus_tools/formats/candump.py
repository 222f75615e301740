# SPDX-License-Identifier: MIT
"""`candump -L` logs of the ISO-TP link: 11-bit normal addressing, ids 0x640+k to the robot and 0x648+k from it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from io import BufferedReader
from typing import BinaryIO, Final

from argus_tools.formats.base import (
    CLIENT_TO_ROBOT,
    ROBOT_TO_CLIENT,
    Chunk,
    Damage,
    Direction,
    Format,
    Offsets,
    ReadOptions,
)

ID_TO_ROBOT: Final = 0x640
ID_FROM_ROBOT: Final = 0x648
ROBOTS: Final = 8
PDU_MAX: Final = 4095
_PADDING: Final = b"\xcc"
_FRAME_BYTES: Final = 8
_LINE_MAX: Final = 4096
_LINE: Final = re.compile(
    rb"\s*\((\d{1,12}\.\d{1,9})\)\s+\S+\s+([0-9A-Fa-f]{3}|[0-9A-Fa-f]{8})#(#[0-9A-Fa-f])?([0-9A-Fa-f.]*)(R\d*)?(\s+[RTX])?\s*$"
)


@dataclass
class _Transfer:
    total: int
    line: int
    data: bytearray
    next_number: int = 1


class CandumpReader:
    """Puts the link's messages together again; other traffic on the bus is passed over."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage: list[Damage] = []
        self._stream = stream
        self._robot = options.robot
        self._others: set[int] = set()
        self._open: dict[Direction, _Transfer] = {}

    def __iter__(self) -> Iterator[Chunk]:
        offsets = Offsets()
        number = 0
        while line := self._stream.readline(_LINE_MAX):
            number += 1
            match = _LINE.match(line)
            if match is None:
                if line.strip():
                    self.damage.append(Damage(f"line {number}", "no candump -L line"))
                continue
            direction = self._direction(int(match[2], 16), number)
            if direction is None or match[5] or len(match[2]) != 3:
                continue
            try:
                payload = bytes.fromhex(match[4].replace(b".", b"").decode())
            except ValueError:
                self.damage.append(Damage(f"line {number}", "an odd number of hexadecimal digits"))
                continue
            if data := self._take(direction, payload, number):
                yield offsets.chunk(float(match[1]), direction, data)
        for direction in tuple(self._open):
            self._give_up(direction, "has no end")

    def _direction(self, can_id: int, line: int) -> Direction | None:
        if not ID_TO_ROBOT <= can_id < ID_FROM_ROBOT + ROBOTS:
            return None
        robot = can_id & (ROBOTS - 1)
        if self._robot is None:
            self._robot = robot
        if robot != self._robot:
            if robot not in self._others:
                self._others.add(robot)
                what = f"robot {robot} is left out, as robot {self._robot} came first; choose with --robot"
                self.damage.append(Damage(f"line {line}", what))
            return None
        return CLIENT_TO_ROBOT if can_id < ID_FROM_ROBOT else ROBOT_TO_CLIENT

    def _give_up(self, direction: Direction, why: str) -> None:
        transfer = self._open.pop(direction, None)
        if transfer:
            got = f"{len(transfer.data)} of {transfer.total} bytes"
            self.damage.append(Damage(f"line {transfer.line}", f"an ISO-TP message {why}: {got} came"))

    def _take(self, direction: Direction, frame: bytes, line: int) -> bytes:
        kind = frame[0] >> 4 if frame else -1
        if kind == 0:
            self._give_up(direction, "is broken off")
            size, at = (frame[0] & 0xF, 1) if frame[0] & 0xF or len(frame) < 2 else (frame[1], 2)
            if 0 < size <= len(frame) - at:
                return frame[at : at + size]
            self.damage.append(Damage(f"line {line}", "an ISO-TP single frame of a wrong length"))
        elif kind == 1 and len(frame) == _FRAME_BYTES:
            self._give_up(direction, "is broken off")
            total = (frame[0] & 0xF) << 8 | frame[1]
            self._open[direction] = _Transfer(total, line, bytearray(frame[2:]))
        elif kind == 2:
            return self._continue(direction, frame)
        elif kind != 3:
            self.damage.append(Damage(f"line {line}", "no ISO-TP frame"))
        return b""

    def _continue(self, direction: Direction, frame: bytes) -> bytes:
        transfer = self._open.get(direction)
        if transfer is None:
            return b""
        if frame[0] & 0xF != transfer.next_number:
            self._give_up(direction, "lacks a frame")
            return b""
        transfer.next_number = (transfer.next_number + 1) & 0xF
        transfer.data += frame[1:]
        if len(transfer.data) < transfer.total:
            return b""
        del self._open[direction]
        return bytes(transfer.data[: transfer.total])


class CandumpWriter:
    """Writes each chunk as ISO-TP frames with the flow control that answers them."""

    def __init__(self, stream: BinaryIO, options: ReadOptions) -> None:
        self._stream = stream
        self._robot = options.robot or 0
        self._t = 0.0

    def write(self, chunk: Chunk) -> None:
        """Append the frames of one chunk, split if it is longer than an ISO-TP message may be."""
        self._t = self._t if chunk.t is None else chunk.t
        for at in range(0, len(chunk.data), PDU_MAX):
            self._message(chunk.dir, chunk.data[at : at + PDU_MAX])

    def close(self) -> None:
        """Nothing stands at the end."""

    def _message(self, direction: Direction, data: bytes) -> None:
        if len(data) < _FRAME_BYTES:
            self._frame(direction, bytes((len(data),)) + data)
            return
        self._frame(direction, bytes((0x10 | len(data) >> 8, len(data) & 0xFF)) + data[:6])
        other = CLIENT_TO_ROBOT if direction == ROBOT_TO_CLIENT else ROBOT_TO_CLIENT
        self._frame(other, b"\x30\0\0")
        for number, at in enumerate(range(6, len(data), 7), start=1):
            self._frame(direction, bytes((0x20 | number & 0xF,)) + data[at : at + 7])

    def _frame(self, direction: Direction, payload: bytes) -> None:
        base = ID_TO_ROBOT if direction == CLIENT_TO_ROBOT else ID_FROM_ROBOT
        padded = payload.ljust(_FRAME_BYTES, _PADDING)
        self._stream.write(f"({self._t:.6f}) can0 {base + self._robot:03X}#{padded.hex().upper()}\n".encode())


FORMAT: Final = Format(
    name="candump",
    help="candump -L of the ISO-TP link",
    sniff=lambda head: bool(_LINE.match(head.lstrip().split(b"\n", 1)[0])),
    reader=CandumpReader,
    writer=CandumpWriter,
    suffixes=(".candump", ".log"),
)
