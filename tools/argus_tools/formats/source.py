# SPDX-License-Identifier: MIT
"""Where a log's bytes come from: a file or standard input, gzip or not, complete or still growing."""

from __future__ import annotations

import io
import os
import stat
import sys
import time
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import IO, TYPE_CHECKING, Final

from argus_tools.chunks import Damage, DamageList, LogError
from argus_tools.formats.text import begins_as_text

if TYPE_CHECKING:
    from _typeshed import WriteableBuffer

HEAD_BYTES: Final = 1 << 16
BLOCK_BYTES: Final = 1 << 17
FOLLOW_PAUSE_S: Final = 0.05
# Enough of a pipe to tell the formats apart, without keeping a live one waiting.
PIPE_HEAD_BYTES: Final = 24
# No packet, and no header of a file, has so many at its beginning.
_ZEROS_MIN: Final = 32
_GZIP_MAGIC: Final = b"\x1f\x8b\x08"
_GZIP_WBITS: Final = 31


class Source(io.RawIOBase):
    """The unzipped bytes of one log; with `follow` its end is waited at, until `stop` says otherwise."""

    def __init__(
        self,
        path: str,
        follow: bool = False,
        stop: Callable[[], bool] = lambda: False,
        on_progress: Callable[[int], None] = lambda _: None,
        is_enough: Callable[[bytes], bool] = lambda _: True,
    ) -> None:
        self.name = path
        self.damage = DamageList()
        self.consumed = 0
        self.is_followed = follow
        self._stop = stop
        self._on_progress = on_progress
        self._file = _open(path)
        status = os.fstat(self._file.fileno())
        self.is_regular = stat.S_ISREG(status.st_mode)
        self.total = status.st_size if self.is_regular else 0
        self._unzip: zlib._Decompress | None = None
        self._zipped = b""
        self._ready = b""
        self._given_up = False
        self.skipped = 0
        self._read_head(is_enough)

    def _read_head(self, is_enough: Callable[[bytes], bool]) -> None:
        first = self._raw(3)
        while first and len(first) < 3 and (more := self._raw(3 - len(first))):
            first += more
        if first == _GZIP_MAGIC:
            self._unzip = zlib.decompressobj(_GZIP_WBITS)
            self._zipped = first
        else:
            self._ready = first
        is_live = self.is_followed or not self.is_regular
        wanted = PIPE_HEAD_BYTES if is_live else HEAD_BYTES
        while len(self._ready) < wanted or (is_live and not is_enough(self._ready)):
            more = self._next()
            if not more:
                break
            self._ready += more
            self._pass_zeros()
        self._pass_zeros()
        if self.skipped:
            what = f"{self.skipped} zeros before the log, as a power cut or a reserved file leaves them: passed over"
            self.damage.correct(Damage("byte 0", what))
        self.head = self._ready

    def _pass_zeros(self) -> None:
        """Leave out zeros at the beginning: many, or any before text."""
        rest = self._ready.lstrip(b"\0")
        zeros = len(self._ready) - len(rest)
        if zeros >= _ZEROS_MIN or (zeros and self.skipped) or (zeros and rest and begins_as_text(rest)):
            self.skipped += zeros
            self._ready = rest

    @property
    def is_zipped(self) -> bool:
        """Whether the file is a gzip file."""
        return self._unzip is not None

    def readable(self) -> bool:
        """A source is for reading only."""
        return True

    def readinto(self, buffer: WriteableBuffer, /) -> int:
        """Fill the buffer with what there is; 0 at the end."""
        if not self._ready:
            self._ready = self._next()
        view = memoryview(buffer).cast("B")
        taken = self._ready[: len(view)]
        view[: len(taken)] = taken
        self._ready = self._ready[len(taken) :]
        return len(taken)

    def close(self) -> None:
        """Close the file, but never standard input."""
        # One that could not be opened is closed as well, by the interpreter.
        file = getattr(self, "_file", None)
        standard = getattr(sys.stdin, "buffer", None)  # None where it was closed before the start
        if not self.closed and file is not None and file is not standard:
            file.close()
        super().close()

    def _raw(self, size: int) -> bytes:
        while True:
            try:
                data = os.read(self._file.fileno(), size)
            except OSError as error:
                raise LogError(f"{self.name}: cannot be read: {error.strerror}") from error
            if data or not self.is_followed or self._stop():
                break
            if not self._is_renewed():
                time.sleep(FOLLOW_PAUSE_S)
        self.consumed += len(data)
        self._on_progress(self.consumed)
        return data

    def _is_renewed(self) -> bool:
        """At the end of a followed file: whether it began anew, because it was rotated or emptied."""
        if not self.is_regular or self._file is getattr(sys.stdin, "buffer", None):
            return False
        try:
            there = os.stat(self.name)  # noqa: PTH116
            ours = os.fstat(self._file.fileno())
            if not os.path.samestat(there, ours):
                renewed = Path(self.name).open("rb", buffering=0)  # noqa: SIM115
                self._file.close()
                self._file = renewed
                what = "the file was replaced; the new one is read from its beginning"
            elif there.st_size < os.lseek(self._file.fileno(), 0, os.SEEK_CUR):
                os.lseek(self._file.fileno(), 0, os.SEEK_SET)
                what = "the file became shorter; it is read from its beginning"
            else:
                return False
        except OSError:
            # Between two files there is none for a moment.
            return False
        self.damage.append(Damage(f"byte {self.consumed}", what))
        return True

    def _give_up(self, what: str) -> None:
        self.damage.append(Damage(f"byte {self.consumed}", what))
        self._given_up = True

    def _next(self) -> bytes:
        if self._given_up:
            return b""
        if self._unzip is None:
            return self._raw(BLOCK_BYTES)
        while True:
            zipped, self._zipped = self._zipped or self._raw(BLOCK_BYTES), b""
            if not zipped:
                if not self._unzip.eof:
                    self._give_up("the gzip file ends in the middle")
                return b""
            if self._unzip.eof:
                if not zipped.strip(b"\0"):
                    continue
                self._unzip = zlib.decompressobj(_GZIP_WBITS)
            before = self._unzip.copy()
            try:
                data = self._unzip.decompress(zipped, BLOCK_BYTES)
            except zlib.error as error:
                self._give_up(f"the gzip file is damaged ({error})")
                return _before_damage(before, zipped)
            self._zipped = self._unzip.unconsumed_tail or self._unzip.unused_data
            if data:
                return data


def _before_damage(unzip: zlib._Decompress, zipped: bytes) -> bytes:
    """Return what comes of these bytes before the damage in them; a wrong checksum stands behind all."""
    out = b""
    try:
        for at in range(len(zipped)):
            out += unzip.decompress(zipped[at : at + 1])
    except zlib.error:
        pass
    return out


def _open(path: str) -> IO[bytes]:
    if path == "-":
        if sys.stdin is None:
            raise LogError("-: standard input is closed; give a log file, or pipe one in")
        return sys.stdin.buffer
    try:
        if Path(path).is_dir():
            # A ROS 2 bag is a folder, which this file describes.
            described = Path(path, "metadata.yaml")
            if not described.is_file():
                raise LogError(f"{path}: is a directory; give a log file, or the folder of a ROS 2 bag")
            return described.open("rb", buffering=0)
        return Path(path).open("rb", buffering=0)
    except OSError as error:
        raise LogError(f"{path}: cannot be opened: {error.strerror}") from error
