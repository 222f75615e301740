# SPDX-License-Identifier: MIT
"""The one type that all log formats are read into and written from, and what a format has to offer."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from io import BufferedReader
from pathlib import PurePath
from typing import BinaryIO, Final, Literal, NamedTuple, Protocol

from hil_sim.errors import InputError

Direction = Literal["r2c", "c2r"]
ROBOT_TO_CLIENT: Final[Direction] = "r2c"
CLIENT_TO_ROBOT: Final[Direction] = "c2r"


def other_direction(direction: Direction) -> Direction:
    """Return the way back."""
    return ROBOT_TO_CLIENT if direction == CLIENT_TO_ROBOT else CLIENT_TO_ROBOT


# What every refusal of a file says that it should have been.
EXPECTED: Final = "a log of a robot's link (argus-log --help lists the forms)"


LogError = InputError
"""What the public API calls it."""


class Chunk(NamedTuple):
    """Bytes that went over the link together; a packet may span chunks and a chunk may hold several packets.

    `t` is in seconds, of any clock that the whole log shares, or None where the format keeps no time.
    `offset` counts the bytes of this direction before `data`; for a raw capture that is the place in the file.
    """

    t: float | None
    dir: Direction
    data: bytes
    offset: int


class Damage(NamedTuple):
    """A part of the file itself that could not be read; `place` says where, as "line 7" or "byte 1234"."""

    place: str
    what: str


class DamageList(list[Damage]):
    """The first entries; of a file that is nothing but damage the others are only counted, in `total`.

    unread: those that could not be read; the others were read with a correction.
    """

    KEPT: Final = 1000

    def __init__(self) -> None:
        super().__init__()
        self.total = 0
        self.unread = 0

    def append(self, entry: Damage, /) -> None:
        """Take note of one more."""
        self.unread += 1
        self.correct(entry)

    def correct(self, entry: Damage, /) -> None:
        """Take note of what was read with a correction, as a time of a clock that was set."""
        self.total += 1
        if self.total <= self.KEPT:
            super().append(entry)


@dataclass
class ReadOptions:
    """What the user said about a log and a format may need to know."""

    direction: Direction | None = None
    port: int | None = None
    robot: int | None = None
    name: str = "-"
    is_zipped: bool = False
    topic: str | None = None
    subclass: str | None = None
    columns: tuple[tuple[str, str], ...] = ()
    """Of a table: names as they are understood, and the columns that have others."""
    skipped: int = 0
    """Set by the opening: zeros that stand before the log and were passed over."""
    absent: frozenset[int] = frozenset()
    """Set by a reader: sonars of which the log shows that the robot has none."""
    tell: Callable[[str], None] = lambda _: None
    """Takes what a reader found out and the user should know, a line each; it is no damage."""


def remedy(command: str, options: ReadOptions) -> str:
    """Return a command that the user may paste: FILE stands for the log's name, and a gzip file is unzipped first."""
    name = "FILE" if options.name == "-" else shlex.quote(options.name)
    if not options.is_zipped or "FILE" not in command:
        return command.replace("FILE", name)
    # Some programs go by the suffix.
    plain = "unzipped" + PurePath(options.name.removesuffix(".gz")).suffix
    return f"gzip -dc {name} > {shlex.quote(plain)} && " + command.replace("FILE", shlex.quote(plain))


class Reader(Protocol):
    """Iterates the chunks of one log, in order, without ever holding the whole of it.

    What it had to skip it appends to `damage` before it yields the next chunk. It raises LogError only when
    nothing can be read at all.
    """

    damage: DamageList

    def __iter__(self) -> Iterator[Chunk]: ...


class Writer(Protocol):
    """Writes chunks in one format; `close` finishes the file but leaves the stream open."""

    def write(self, chunk: Chunk) -> None:
        """Append one chunk."""

    def close(self) -> None:
        """Write what the format wants at its end."""


def begins(*starts: bytes) -> Callable[[bytes], bool]:
    """Return what recognises a file by any of the bytes that it begins with."""
    return lambda head: head.startswith(starts)


@dataclass(frozen=True)
class Format:
    """One log format: how it is called, recognised, read and written.

    `sniff` sees the first bytes of the file (up to 64 KiB, already unzipped) and says whether they are of
    this format. `reader` gets a stream whose reads wait for more when the log is followed. What is not read is
    only recognised: its reader raises LogError with the name of what it is and the remedy.
    """

    name: str
    help: str
    sniff: Callable[[bytes], bool]
    reader: Callable[[BufferedReader, ReadOptions], Reader]
    writer: Callable[[BinaryIO, ReadOptions], Writer] | None = None
    suffixes: tuple[str, ...] = ()
    is_read: bool = True


@dataclass
class Offsets:
    """Counts the bytes of each direction, for readers that see one chunk after the other."""

    at: dict[Direction, int] = field(default_factory=lambda: {ROBOT_TO_CLIENT: 0, CLIENT_TO_ROBOT: 0})

    def chunk(self, t: float | None, direction: Direction, data: bytes) -> Chunk:
        """Return a chunk that follows those before it."""
        offset = self.at[direction]
        self.at[direction] = offset + len(data)
        return Chunk(t, direction, data, offset)


def copy(chunks: Iterable[Chunk], writer: Writer) -> int:
    """Write all chunks and close the writer; return how many there were."""
    count = 0
    for chunk in chunks:
        writer.write(chunk)
        count += 1
    writer.close()
    return count
