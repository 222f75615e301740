# SPDX-License-Identifier: MIT
"""Recordings of a link (SPEC.md, Recording): their bytes, a reader that survives damage, and a recorder."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
import stat
import struct
import threading
import time
import zlib
from collections.abc import Callable, Iterator
from enum import IntEnum
from pathlib import Path
from typing import Final, NamedTuple

from hil_sim.claim import holder
from hil_sim.errors import SimError

MAGIC: Final = b"ARGUSREC"
VERSION: Final = 1
SYNC: Final = b"\xa5\xc3"
PAYLOAD_MAX: Final = 4096
CLOCK_US: Final = 1_000_000
KEPT: Final = 4
MAX_BYTES: Final = 64_000_000
_WRITE_MAX: Final = 512
_HEAD: Final = struct.Struct("<2sBHI")
_BODY: Final = struct.Struct("<BHI")
_CLOCK: Final = struct.Struct("<qq")
_CRC_BYTES: Final = 4
_SHORTEST: Final = _HEAD.size + _CRC_BYTES
_SYNC_S: Final = 0.5
_RESTART_US: Final = 10_000_000
"""A monotonic clock that falls by more than this is another one: the machine was started again."""


class Kind(IntEnum):
    """What a record holds."""

    HEADER = 0
    FROM_ROBOT = 1
    TO_ROBOT = 2
    CLOCK = 3
    LOST = 4
    INJECTED = 5


# As plain numbers, which compare faster.
_LINK_KINDS: Final = (int(Kind.FROM_ROBOT), int(Kind.TO_ROBOT))


class Record(NamedTuple):
    """One record; `place` is its first byte in the file, `time_us` the low 32 bits of the monotonic clock."""

    kind: int
    time_us: int
    payload: bytes
    place: int


class Gap(NamedTuple):
    """A part of a file that holds no whole record."""

    place: int
    length: int
    at_end: bool


def encode(kind: int, mono_us: int, payload: bytes) -> bytes:
    """Return the bytes of one record."""
    body = _BODY.pack(kind, len(payload), mono_us & 0xFFFFFFFF) + payload
    return SYNC + body + zlib.crc32(body).to_bytes(_CRC_BYTES, "little")


def encode_clock(mono_us: int, wall_us: int) -> bytes:
    """Return a clock record: the monotonic and the wall clock at one moment."""
    return encode(Kind.CLOCK, mono_us, _CLOCK.pack(mono_us, wall_us))


def encode_start(source: str, mono_us: int, wall_us: int) -> bytes:
    """Return what a file begins with: the header, which says who records what, and the clock."""
    header = encode(Kind.HEADER, mono_us, MAGIC + bytes((VERSION,)) + source.encode()[:200])
    return header + encode_clock(mono_us, wall_us)


def is_recording(head: bytes) -> bool:
    """Tell whether a file that begins with `head` is a recording.

    A power cut may have left zeros at its beginning, or torn its first header, behind which comes another.
    """
    head = head.lstrip(b"\0")
    return head.startswith(SYNC[:1]) and MAGIC in head[: 2 * (_HEAD.size + len(MAGIC))]


class Decoder:
    """Takes a file in pieces and gives its records; what is none goes into `gaps`, in order."""

    def __init__(self) -> None:
        self.gaps: list[Gap] = []
        self._held = b""
        self._place = 0
        self._skipped = 0

    def feed(self, data: bytes) -> Iterator[Record]:
        """Yield the records that are complete now."""
        return self._scan(data, final=False)

    def finish(self) -> Iterator[Record]:
        """Yield what a torn record at the end had hidden; call once, after the last piece."""
        yield from self._scan(b"", final=True)
        self._close_gap(self._place, at_end=True)

    def _close_gap(self, place: int, *, at_end: bool = False) -> None:
        if self._skipped:
            self.gaps.append(Gap(place - self._skipped, self._skipped, at_end))
            self._skipped = 0

    def _scan(self, data: bytes, *, final: bool) -> Iterator[Record]:
        held = self._held + data
        at = 0
        while at < len(held):
            for end, record in self._whole(held, at):
                at = end
                yield record
            if at >= len(held):
                break
            end = _end_of(held, at)
            if end > len(held) and not final:
                break
            if at < end <= len(held) and _is_whole(held, at, end):
                _, kind, _, time_us = _HEAD.unpack_from(held, at)
                self._close_gap(self._place + at)
                yield Record(kind, time_us, held[at + _HEAD.size : end - _CRC_BYTES], self._place + at)
                at = end
            else:
                after = held.find(SYNC[:1], at + 1)
                after = len(held) if after < 0 else after
                self._skipped += after - at
                at = after
        self._held = held[at:]
        self._place += at

    def _whole(self, held: bytes, at: int) -> Iterator[tuple[int, Record]]:
        """Yield whole records one after the other, each with where it ends: most of most files, so written out."""
        size, new, unpack = len(held), tuple.__new__, _HEAD.unpack_from
        while size - at >= _SHORTEST:
            sync, kind, length, time_us = unpack(held, at)
            end = at + length + _SHORTEST
            if sync != SYNC or length > PAYLOAD_MAX or end > size:
                return
            payload_end = end - _CRC_BYTES
            crc = zlib.crc32(held[at + 2 : payload_end])
            if held[payload_end:end] != crc.to_bytes(_CRC_BYTES, "little"):
                return
            if self._skipped:
                self._close_gap(self._place + at)
            payload = held[at + _HEAD.size : payload_end]
            record = new(Record, (kind, time_us, payload, self._place + at))
            at = end
            yield at, record


def _end_of(held: bytes, at: int) -> int:
    """Where the record that seems to begin here ends, as far as can be told; `at` when none does."""
    if not SYNC.startswith(held[at : at + len(SYNC)]):
        return at
    if len(held) - at < _HEAD.size:
        return at + _HEAD.size + _CRC_BYTES
    length = int(_HEAD.unpack_from(held, at)[2])
    return at if length > PAYLOAD_MAX else at + _HEAD.size + length + _CRC_BYTES


def _is_whole(held: bytes, at: int, end: int) -> bool:
    body_end = end - _CRC_BYTES
    return zlib.crc32(held[at + len(SYNC) : body_end]) == int.from_bytes(held[body_end:end], "little")


class Timeline:
    """Turns the times of records into seconds since 1970, steady however the wall clock was set meanwhile."""

    def __init__(self) -> None:
        self._mono_us: int | None = None
        self._anchor_us: int | None = None

    def at(self, record: Record) -> float | None:
        """Return when this record was made; None as long as no clock was read."""
        if record.kind not in _LINK_KINDS:
            self._take_clock(record)
        if self._mono_us is None or self._anchor_us is None:
            return None
        ahead = (record.time_us - self._mono_us) & 0xFFFFFFFF
        self._mono_us += ahead - (1 << 32 if ahead >= 1 << 31 else 0)
        return (self._anchor_us + self._mono_us) / 1e6

    def _take_clock(self, record: Record) -> None:
        if record.kind == Kind.HEADER:
            self._mono_us = self._anchor_us = None
        elif record.kind == Kind.CLOCK and len(record.payload) == _CLOCK.size:
            mono_us, wall_us = _CLOCK.unpack(record.payload)
            if self._anchor_us is None or (self._mono_us or 0) - mono_us > _RESTART_US:
                self._anchor_us = wall_us - mono_us
            self._mono_us = mono_us


class Recorder:
    """Appends what passes on a link to a file; a disk that refuses is said once and waited for.

    `say` gets that one line. Past `max_bytes` FILE becomes FILE.1, and so on to FILE.4.
    """

    def __init__(
        self,
        path: str | Path,
        source: str,
        say: Callable[[str], None],
        max_bytes: int = MAX_BYTES,
    ) -> None:
        self.lost = 0
        self._path = Path(path)
        self._source = source
        self._say = say
        self._max_bytes = max_bytes
        self._clock_us = 0
        self._unsaid = 0
        self._torn = b""
        self._said = False
        self._ended = threading.Event()
        self._fd = -1
        self._size = 0
        self._open()
        self._write(self._start())
        self._syncer = threading.Thread(target=self._sync, daemon=True)
        self._syncer.start()

    def note(self, kind: Kind, data: bytes) -> None:
        """Take bytes that have just passed."""
        mono_us, wall_us = _now_us()
        out = b""
        if not 0 <= mono_us - self._clock_us < CLOCK_US:
            self._clock_us = mono_us
            out = encode_clock(mono_us, wall_us)
        for at in range(0, len(data), _WRITE_MAX):
            out += encode(kind, mono_us, data[at : at + _WRITE_MAX])
        if self._unsaid:
            out = encode(Kind.LOST, mono_us, min(self._unsaid, 0xFFFFFFFF).to_bytes(4, "little")) + out
        if self._write(out):
            self._unsaid = 0
        else:
            self.lost += len(data)
            self._unsaid += len(data)

    def close(self) -> None:
        """End the recording; may be called twice."""
        self._ended.set()
        self._syncer.join()
        if self._fd >= 0:
            with contextlib.suppress(OSError):
                os.fdatasync(self._fd)
            os.close(self._fd)
            self._fd = -1

    def _start(self) -> bytes:
        return encode_start(self._source, *_now_us())

    def _open(self) -> None:
        """Open FILE, or raise SimError when it may not be used."""
        flags = os.O_RDWR | os.O_APPEND | os.O_CREAT | os.O_CLOEXEC | os.O_NONBLOCK | os.O_NOCTTY
        try:
            fd = os.open(self._path, flags, 0o666)
        except (OSError, ValueError) as error:
            why = getattr(error, "strerror", None) or str(error)
            raise SimError(f"--record {self._path}: {why}; name a file that can be written") from error
        try:
            self._check(fd)
        except SimError:
            os.close(fd)
            raise
        self._fd = fd
        self._size = os.fstat(fd).st_size

    def _check(self, fd: int) -> None:
        if not stat.S_ISREG(os.fstat(fd).st_mode):
            raise SimError(f"--record {self._path}: it is no regular file; name another")
        head = os.pread(fd, _HEAD.size + len(MAGIC), 0)
        begin = SYNC + bytes((Kind.HEADER,))
        is_ours = begin.startswith(head[:3]) and MAGIC.startswith(head[_HEAD.size :])
        if head.strip(b"\0") and not is_ours:
            raise SimError(f"--record {self._path}: it exists and is no recording; name another file")
        try:
            fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise SimError(f"--record {self._path}: {holder(fd)} records there; name another file") from error

    def _rotate(self) -> None:
        for number in range(KEPT - 1, -1, -1):
            old = self._path.with_name(f"{self._path.name}.{number}") if number else self._path
            with contextlib.suppress(FileNotFoundError):
                old.replace(self._path.with_name(f"{self._path.name}.{number + 1}"))
        os.close(self._fd)
        self._fd = -1

    def _write(self, data: bytes) -> bool:
        """Write whole records; False when the disk would not take even the first byte."""
        try:
            while self._torn:
                self._torn = self._torn[self._put(self._torn) :]
            if self._fd >= 0 and self._size and self._size + len(data) > self._max_bytes:
                self._rotate()
            if self._fd < 0:
                self._open()
                data = self._start() + data
            self._torn = data[self._put(data) :]
        except (OSError, SimError) as error:
            self._complain(error)
            return False
        return True

    def _put(self, data: bytes) -> int:
        written = os.write(self._fd, data)
        if not written:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        self._size += written
        return written

    def _complain(self, error: Exception) -> None:
        if not self._said:
            self._said = True
            why = getattr(error, "strerror", None) or str(error)
            self._say(f"--record {self._path}: {why}; going on without, until there is room again")

    def _sync(self) -> None:
        """Bring what was written to the disk, aside, because that may take long."""
        while not self._ended.wait(_SYNC_S):
            with contextlib.suppress(OSError):
                os.fdatasync(self._fd)


def _now_us() -> tuple[int, int]:
    return time.monotonic_ns() // 1000, time.time_ns() // 1000
