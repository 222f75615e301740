# SPDX-License-Identifier: MIT
"""Raw serial captures of one direction, as any terminal program writes them; they keep no time."""

from __future__ import annotations

from collections.abc import Iterator
from io import BufferedReader
from typing import BinaryIO, Final

from argus_tools.catalogue import HELP
from argus_tools.chunks import (
    CLIENT_TO_ROBOT,
    ROBOT_TO_CLIENT,
    Chunk,
    Damage,
    DamageList,
    Direction,
    Format,
    LogError,
    ReadOptions,
)
from argus_tools.formats.telnet import Telnet
from hil_sim.arcos import ARGUMENT, SIP, TYPE, Unframer

BLOCK_BYTES: Final = 1 << 16
# Where the first blocks show nothing, as the text of a boot before the log, so many are waited for.
_GUESS_BYTES: Final = 1 << 20
_UNTOLD: Final = (
    "nothing shows whose bytes these are; they are taken as the client's: --dir r2c for the robot's"
)
_ARGUMENTS: Final = frozenset(ARGUMENT.values())
_ANSWERS: Final = frozenset((TYPE["CONFIGPAC"], TYPE["SIP_STATIONARY"], TYPE["SIP_MOVING"]))
_ANSWER_MIN: Final = SIP["OFFSET_SONAR"] - 3


def guess_direction(head: bytes) -> Direction:
    """Say who sent these bytes: commands are short and their arguments are typed, a robot's packets are not.

    >>> guess_direction(bytes.fromhex("fafb060b1b2c01371c"))
    'c2r'
    """
    return guessed(head) or CLIENT_TO_ROBOT


def guessed(head: bytes) -> Direction | None:
    """Say who sent these bytes; None where nothing shows it."""
    robot = client = 0
    for data in Unframer().feed(head):
        if len(data) == 1:
            continue
        if data[1] in _ARGUMENTS and not (data[0] in _ANSWERS and len(data) >= _ANSWER_MIN):
            client += 1
        else:
            robot += 1
    if robot == client:
        return None
    return ROBOT_TO_CLIENT if robot > client else CLIENT_TO_ROBOT


class BinReader:
    """Reads a raw capture in blocks."""

    def __init__(self, stream: BufferedReader, options: ReadOptions) -> None:
        self.damage = DamageList()
        self._stream = stream
        self._direction = options.direction
        self._skipped = options.skipped

    def __iter__(self) -> Iterator[Chunk]:
        at = self._skipped
        for block in self._blocks():
            assert self._direction is not None
            yield Chunk(None, self._direction, block, at)
            at += len(block)

    def _blocks(self) -> Iterator[bytes]:
        """Yield the blocks, from where it shows whose they are."""
        held: list[bytes] = []
        size = 0
        while self._direction is None and size < _GUESS_BYTES and (block := self._stream.read1(BLOCK_BYTES)):
            held.append(block)
            size += len(block)
            so_far = b"".join(held)
            self._direction = guessed(so_far) or guessed(Telnet().feed(so_far))
        if self._direction is None:
            self._direction = CLIENT_TO_ROBOT
            if any(True for _ in Unframer().feed(b"".join(held))):
                self.damage.correct(Damage("byte 0", _UNTOLD))
        yield from held
        yield from iter(lambda: self._stream.read1(BLOCK_BYTES), b"")


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
    help=HELP["bin"],
    sniff=lambda head: True,
    reader=BinReader,
    writer=BinWriter,
    suffixes=(".bin", ".raw"),
)
