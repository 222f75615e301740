# SPDX-License-Identifier: MIT
"""The truth record: one JSON object per line, written as it happens, for judging what a client believed."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any, Self, TextIO

from hil_sim.errors import SimError

Log = Callable[[str, dict[str, Any]], None]
"""Receives one truth record: its type and its fields, `t_s` included."""


class TruthRecord:
    """Writes truth records to a file; callable as a `Log`.

    Types: meta, clock, state (each 100 ms), sonar, fault, collision, struck (a solid met the robot at
    rest), bumper, watchdog, link, session, late (the host served the robot `late_ms`, more than 100,
    after it was due). All but meta have `t_s`, seconds of robot time since the start.
    """

    def __init__(self, path: str | Path, meta: dict[str, Any]) -> None:
        try:
            self._file: TextIO = Path(path).open("w", encoding="utf-8")  # noqa: SIM115 (held until close)
        except OSError as error:
            raise SimError(
                f"{path}: cannot write the truth record ({error.strerror}); name another file"
            ) from error
        self("meta", meta)

    def __call__(self, kind: str, fields: dict[str, Any]) -> None:
        """Write one record and flush it, so that a reader or a crash finds it whole."""
        if self._file.closed:
            return
        self._file.write(json.dumps({"type": kind, **fields}, separators=(",", ":")) + "\n")
        self._file.flush()

    def close(self) -> None:
        """Close the file; later records are dropped."""
        self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
