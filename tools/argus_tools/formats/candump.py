# SPDX-License-Identifier: MIT
"""`candump -L` logs of the ISO-TP link: 11-bit normal addressing, ids 0x640+k to the robot and 0x648+k from it."""

from __future__ import annotations

import re
from binascii import unhexlify
from collections.abc import Iterator
from dataclasses import dataclass
from io import BufferedReader
from typing import BinaryIO, Final

from argus_tools.formats.base import (
    CLIENT_TO_ROBOT,
    ROBOT_TO_CLIENT,
    Chunk,
    Damage,
    DamageList,
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
# More than any message of a robot's link.
_MESSAGE_MAX: Final = 1 << 16
_NEXT_BYTES: Final = tuple(bytes((0x20 | number,)) for number in range(16))
_LINE: Final = re.compile(
    rb"\s*\((\d{1,12}\.\d{1,9})\)\s+(\S+)\s+([0-9A-Fa-f]{3}|[0-9A-Fa-f]{8})#"
    rb"(?:R[0-9A-Fa-f_]*|(?:#[0-9A-Fa-f])?([0-9A-Fa-f.]*))(?:\s+[RTX])*\s*"
)
_USUAL: Final = re.compile(rb"\((\d{1,12}\.\d{1,9})\) (\S+) ([0-9A-Fa-f]{3})#([0-9A-Fa-f]{2,16})\n")
_ID_DIGITS: Final = 3
_SINGLE, _FIRST, _NEXT, _FLOW_CONTROL = range(4)


@dataclass
class _Transfer:
    total: int
    line: int
    data: bytearray
    next_number: int = 1


class CandumpReader:
    """Puts the link's messages together again; other traffic on the bus is passed over.

    Of a message that is broken off, what came is passed on, so that its packet is seen as damaged.
    """

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self._stream = stream
        self._robot = options.robot
        self._is_asked = options.robot is not None
        self._bus: bytes | None = None
        self._others: set[int | bytes] = set()
        self._open: dict[Direction, _Transfer] = {}
        self._torn: set[Direction] = set()

    def __iter__(self) -> Iterator[Chunk]:
        offsets = Offsets()
        directions: dict[tuple[bytes, bytes], Direction | None] = {}
        usual, transfers = _USUAL.fullmatch, self._open
        number = 0
        t = b"0"
        while line := self._stream.readline(_LINE_MAX):
            number += 1
            fields = usual(line) or self._unusual(line, number)
            if fields is None:
                continue
            t, bus, can_id, digits = fields.groups()
            try:
                direction = directions[bus, can_id]
            except KeyError:
                direction = self._direction(bus, can_id, number)
                directions[bus, can_id] = direction
            if direction is None or not digits:
                continue
            try:
                frame = unhexlify(digits)
            except ValueError:
                frame = self._dotted(digits, number)
            transfer = transfers.get(direction)
            if (
                transfer
                and frame[:1] == _NEXT_BYTES[transfer.next_number]
                and len(transfer.data) + len(frame) <= transfer.total
            ):
                # The middle of a message: most lines of most logs.
                transfer.data += frame[1:]
                transfer.next_number = (transfer.next_number + 1) & 0xF
                continue
            for data in self._take(direction, frame, number):
                yield offsets.chunk(float(t), direction, data)
        for direction in tuple(self._open):
            for data in self._give_up(direction, "has no end"):
                yield offsets.chunk(float(t), direction, data)

    def _unusual(self, line: bytes, number: int) -> re.Match[bytes] | None:
        fields = _LINE.fullmatch(line)
        if fields is None and line.strip():
            self.damage.append(Damage(f"line {number}", "no candump -L line"))
        return fields

    def _dotted(self, digits: bytes, number: int) -> bytes:
        try:
            return unhexlify(digits.replace(b".", b""))
        except ValueError:
            self.damage.append(Damage(f"line {number}", "an odd number of hexadecimal digits"))
            return b""

    def _direction(self, bus: bytes, id_digits: bytes, line: int) -> Direction | None:
        can_id = int(id_digits, 16)
        if len(id_digits) != _ID_DIGITS or not ID_TO_ROBOT <= can_id < ID_FROM_ROBOT + ROBOTS:
            return None
        robot = can_id & (ROBOTS - 1)
        if self._robot is None:
            self._robot = robot
        if robot != self._robot and self._is_asked:
            return None
        if robot != self._robot:
            first = f"robot {self._robot} came first; choose with --robot"
            self._leave_out(robot, f"robot {robot} is left out, as {first}", line)
            return None
        if self._bus is None:
            self._bus = bus
        if bus != self._bus:
            name, first = (word.decode("latin-1") for word in (bus, self._bus))
            self._leave_out(bus, f"interface {name} is left out, as robot {robot} was first on {first}", line)
            return None
        return CLIENT_TO_ROBOT if can_id < ID_FROM_ROBOT else ROBOT_TO_CLIENT

    def _leave_out(self, other: int | bytes, what: str, line: int) -> None:
        if other not in self._others:
            self._others.add(other)
            self.damage.append(Damage(f"line {line}", what))

    def _give_up(self, direction: Direction, why: str) -> Iterator[bytes]:
        transfer = self._open.pop(direction, None)
        if transfer:
            got = f"{len(transfer.data)} of {transfer.total} bytes"
            self.damage.append(Damage(f"line {transfer.line}", f"an ISO-TP message {why}: {got} came"))
            yield bytes(transfer.data)

    def _take(self, direction: Direction, frame: bytes, line: int) -> Iterator[bytes]:
        """Take a frame; yield the message that it completes, or what came of one that it breaks off."""
        kind = frame[0] >> 4 if frame else -1
        if kind == _SINGLE:
            yield from self._give_up(direction, "is broken off")
            # Frames of CAN FD have their length in a second byte.
            at = 1 if len(frame) <= _FRAME_BYTES or frame[0] & 0xF else 2
            size = frame[at - 1] & (0xF if at == 1 else 0xFF)
            if 0 < size <= len(frame) - at:
                yield frame[at : at + size]
            else:
                self._complain(line, f"an ISO-TP single frame of a wrong length, {size}")
        elif kind == _FIRST:
            yield from self._give_up(direction, "is broken off")
            self._begin(direction, frame, line)
        elif kind == _NEXT:
            yield from self._continue(direction, frame, line)
        elif kind != _FLOW_CONTROL and frame:
            self._complain(line, "no ISO-TP frame")

    def _begin(self, direction: Direction, frame: bytes, line: int) -> None:
        total, at = int.from_bytes(frame[:2], "big") & 0xFFF, 2
        if not total:
            # Longer ones have their length in four bytes more.
            total, at = int.from_bytes(frame[2:6], "big"), 6
        if len(frame) < _FRAME_BYTES or not len(frame) - at < total <= _MESSAGE_MAX:
            self._torn.add(direction)
            self._complain(line, f"an ISO-TP first frame of a wrong length, {total}")
            return
        self._torn.discard(direction)
        self._open[direction] = _Transfer(total, line, bytearray(frame[at:]))

    def _continue(self, direction: Direction, frame: bytes, line: int) -> Iterator[bytes]:
        transfer = self._open.get(direction)
        if transfer is None:
            if direction not in self._torn:
                self._torn.add(direction)
                self._complain(line, "the end of an ISO-TP message whose beginning is missing")
            return
        if frame[0] & 0xF != transfer.next_number:
            self._torn.add(direction)
            yield from self._give_up(direction, "lacks a frame")
            return
        transfer.next_number = (transfer.next_number + 1) & 0xF
        transfer.data += frame[1:]
        if len(transfer.data) >= transfer.total:
            del self._open[direction]
            yield bytes(transfer.data[: transfer.total])

    def _complain(self, line: int, what: str) -> None:
        self.damage.append(Damage(f"line {line}", what))


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
    sniff=lambda head: bool(_LINE.fullmatch(head.lstrip().split(b"\n", 1)[0])),
    reader=CandumpReader,
    writer=CandumpWriter,
    suffixes=(".candump", ".log"),
)
