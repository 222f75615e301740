# SPDX-License-Identifier: MIT
"""ROS 1 and ROS 2 bags and MCAP: the ranges and poses in them become the packets of a robot with that ring."""

from __future__ import annotations

import re
import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import suppress
from io import BufferedReader
from pathlib import Path
from typing import Final

from argus_tools.catalogue import HELP
from argus_tools.chunks import Chunk, DamageList, Format, LogError, Reader, ReadOptions, begins
from argus_tools.rings.own import OwnLog, is_own
from argus_tools.rings.packets import RangeLog
from argus_tools.rings.recording import Bag, OwnMcap, Recording

_ROS1: Final = b"#ROSBAG V2.0\n"
_SQLITE: Final = b"SQLite format 3\0"
_MCAP: Final = b"\x89MCAP0\r\n"
_METADATA: Final = b"rosbag2_bagfile_information:"
METADATA_NAME: Final = "metadata.yaml"


class _File:
    """The recording as a file that can be read at any place: itself, or a copy of what is zipped or comes by a pipe."""

    def __init__(self, stream: BufferedReader, options: ReadOptions, suffix: str) -> None:
        self._copy: tempfile.TemporaryDirectory[str] | None = None
        self.path = Path(options.name)
        if self.path.name == METADATA_NAME:
            self.path = self.path.parent
        if (
            options.name != "-"
            and not options.is_zipped
            and (self.path.is_dir() or self.path.suffix == suffix)
        ):
            return
        self._copy = tempfile.TemporaryDirectory()
        original, self.path = self.path, Path(self._copy.name, f"bag{suffix}")
        if options.name != "-" and not options.is_zipped:
            self.path.symlink_to(original.absolute())
            return
        with self.path.open("wb") as file:
            shutil.copyfileobj(stream, file)

    def close(self) -> None:
        """Remove the copy."""
        if self._copy is not None:
            with suppress(OSError):
                self._copy.cleanup()


class _Opened:
    """A recording together with its file."""

    def __init__(self, file: _File, recording: Recording) -> None:
        self._file, self._recording = file, recording
        self.topics = recording.topics
        self.messages = recording.messages

    def close(self) -> None:
        """Close both."""
        self._recording.close()
        self._file.close()


def _opened(stream: BufferedReader, options: ReadOptions, suffix: str) -> Recording:
    file = _File(stream, options, suffix)
    try:
        return _Opened(file, _recording(file.path, suffix, options))
    except BaseException:
        file.close()
        raise


def _recording(path: Path, suffix: str, options: ReadOptions) -> Recording:
    if suffix == ".mcap" and not path.is_dir():
        own = OwnMcap(path, options.name)
        if own.topics:
            return own
        own.close()
    return Bag(path, suffix == ".bag", options.name)


def recording_of(path: Path) -> Recording:
    """Open a bag by its name, a file or a folder; LogError where it cannot be read."""
    if not path.exists():
        raise LogError(f"{path}: no such file")
    return _recording(path, path.suffix, ReadOptions(name=str(path)))


def _reads(suffix: str) -> Callable[[BufferedReader, ReadOptions], Reader]:
    return lambda stream, options: _Either(lambda: _opened(stream, options, suffix), options)


class _Either:
    """The reader: of Argus' own recordings, or of ranges and poses of any robot."""

    def __init__(self, opened: Callable[[], Recording], options: ReadOptions) -> None:
        self.damage = DamageList()
        self._opened, self._options = opened, options
        self._reader: OwnLog | RangeLog | None = None

    @property
    def place(self) -> str:
        """Where in the recording the last chunk came from."""
        return self._reader.place if self._reader else ""

    def __iter__(self) -> Iterator[Chunk]:
        recording = self._opened()
        make = OwnLog if is_own(recording.topics) else RangeLog
        self._reader = make(lambda: recording, self._options)
        self._reader.damage = self.damage
        yield from self._reader


def _is_database(head: bytes) -> bool:
    """Whether it is SQLite with the tables of a bag: the first page holds what made them."""
    return (
        head.startswith(_SQLITE) and re.search(rb"CREATE TABLE \W?topics\b", head, re.IGNORECASE) is not None
    )


FORMATS: Final = (
    Format("bag1", HELP["bag1"], begins(_ROS1), _reads(".bag")),
    Format("bag2", HELP["bag2"], begins(_METADATA), _reads("")),
    Format("bag2-db3", HELP["bag2-db3"], _is_database, _reads(".db3")),
    Format("mcap", HELP["mcap"], begins(_MCAP), _reads(".mcap")),
)
