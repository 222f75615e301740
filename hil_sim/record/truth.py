# SPDX-License-Identifier: MIT
"""The truth record: one JSON object per line, written as it happens, for judging what a client believed."""

from __future__ import annotations

import contextlib
import json
from collections.abc import Callable
from io import RawIOBase
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from hil_sim.errors import SimError

Log = Callable[[str, dict[str, Any]], None]
"""Receives one truth record: its type and its fields, `t_s` included."""


class TruthRecord:
    """Writes truth records to a file; callable as a `Log`.

    Types: meta, clock, state (each 100 ms), sonar, fault, collision, struck (a solid met the robot at rest),
    bumper, watchdog, link, session, late. `late`: the host served the robot `late_ms`, more than 100, after
    it was due. All but meta have `t_s`, seconds of robot time since the start.
    """

    def __init__(
        self, path: str | Path, meta: dict[str, Any], say: Callable[[str], None] = lambda text: None
    ) -> None:
        """`say` is called once when the disk is full later on; at the beginning that is a SimError."""
        self._path = path
        self._began = False
        try:
            # Unbuffered: each record is written whole, or not at all.
            self._file: RawIOBase = Path(path).open("wb", buffering=0)  # noqa: SIM115 (held until close)
        except OSError as error:
            raise SimError(
                f"{path}: cannot write the truth record ({error.strerror}); name another file"
            ) from error
        self._say = say
        self._full = False
        self._whole = 0
        self._error: str | None = None
        self("meta", meta)
        if self._full:
            self.close()
            raise SimError(
                f"{path}: cannot write the truth record ({self._error}); make room, or name another file"
            )
        self._began = True

    def __call__(self, kind: str, fields: dict[str, Any]) -> None:
        """Write one record and flush it, so that a reader or a crash finds it whole."""
        if self._file.closed:
            return
        line = json.dumps({"type": kind, **fields}, separators=(",", ":")) + "\n"
        data = line.encode()
        try:
            written = 0
            while written < len(data):
                written += self._file.write(data[written:]) or 0
            self._whole += written
        except OSError as error:
            # Half a line would be none of a record; a pipe cannot be cut.
            with contextlib.suppress(OSError):
                self._file.truncate(self._whole)
            self._lose(error)

    def _lose(self, error: OSError) -> None:
        """Tell once, and go on: the robot is served whatever becomes of the record."""
        self._full = True
        self._error = error.strerror
        if self._began:
            self._say(f"{self._path}: the truth record ends here ({error.strerror}); the robot goes on")
            self.close()

    def fileno(self) -> int:
        """The descriptor that it is written to."""
        return self._file.fileno()

    def close(self) -> None:
        """Close the file; later records are dropped."""
        self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
