# SPDX-License-Identifier: MIT
"""Raw serial captures of one direction, as any terminal program writes them; they keep no time."""

from __future__ import annotations

from collections.abc import Iterator
from io import BufferedReader
from typing import BinaryIO, Final

from argus_tools.chunks import (
    CLIENT_TO_ROBOT,
    ROBOT_TO_CLIENT,
    Chunk,
    DamageList,
    Direction,
    Format,
    LogError,
    ReadOptions,
)
from hil_sim.arcos import ARGUMENT, SIP, TYPE, Unframer

BLOCK_BYTES: Final = 1 << 16
_GUESS_BYTES: Final = 1 << 14
_ARGUMENTS: Final = frozenset(ARGUMENT.values())
_ANSWERS: Final = frozenset((TYPE["CONFIGPAC"], TYPE["SIP_STATIONARY"], TYPE["SIP_MOVING"]))
_ANSWER_MIN: Final = SIP["OFFSET_SONAR"] - 3


def guess_direction(head: bytes) -> Direction:
    """Say who sent these bytes: commands are short and their arguments are typed, a robot's packets are not.

    >>> guess_direction(bytes.fromhex("fafb060b1b2c01371c"))
    'c2r'
    """
    robot = client = 0
    for data in Unframer().feed(head[:_GUESS_BYTES]):
        if len(data) == 1:
            continue
        if data[1] in _ARGUMENTS and not (data[0] in _ANSWERS and len(data) >= _ANSWER_MIN):
            client += 1
        else:
            robot += 1
    return ROBOT_TO_CLIENT if robot > client else CLIENT_TO_ROBOT


class BinReader:
    """Reads a raw capture in blocks."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self._stream = stream
        self._direction = options.direction

    def __iter__(self) -> Iterator[Chunk]:
        at = 0
        while block := self._stream.read1(BLOCK_BYTES):
            if self._direction is None:
                self._direction = guess_direction(block)
            yield Chunk(None, self._direction, block, at)
            at += len(block)


class BinWriter:
    """Writes the bytes of one direction, and nothing else."""

    def __init__(self, stream: BinaryIO, options: ReadOptions) -> None:
        self._stream = stream
        self._asked = options.direction
        self._direction = options.direction

    def write(self, chunk: Chunk) -> None:
        """Append the chunk's bytes; with a direction given, those of the other are left out."""
        if chunk.dir == self._direction:
            self._stream.write(chunk.data)
        elif self._direction is None:
            self._direction = chunk.dir
            self._stream.write(chunk.data)
        elif self._asked is None:
            raise LogError("this log has both directions and a .bin holds one: add --dir r2c or --dir c2r")

    def close(self) -> None:
        """Nothing stands at the end."""


FORMAT: Final = Format(
    name="bin",
    help="raw bytes of one direction, no times",
    sniff=lambda head: True,
    reader=BinReader,
    writer=BinWriter,
    suffixes=(".bin", ".raw"),
)
