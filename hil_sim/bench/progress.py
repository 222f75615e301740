# SPDX-License-Identifier: MIT
"""Tells how far a bench is."""

from __future__ import annotations

import os
import time
from typing import Any, TextIO


class Progress:
    """Tells on standard error how far it is: a line that is rewritten on a terminal, one each 10 s elsewhere."""

    def __init__(self, total: int, before: int, stream: TextIO) -> None:
        self.total, self.before, self.done = total, before, 0
        self.simulated_s = 0.0
        self.errors = 0
        self._stream = stream
        self._live = stream.isatty() and os.environ.get("TERM") != "dumb"
        self._begin = time.monotonic()
        self._said = self._begin - (0 if not self._live else 10)

    def add(self, record: dict[str, Any]) -> None:
        """Count a mission."""
        self.done += 1
        self.errors += record["error"] is not None
        self.simulated_s += record.get("t_s") or 0.0
        now = time.monotonic()
        if now - self._said >= (0.2 if self._live else 10.0):
            self._said = now
            self._say(now)

    def _say(self, now: float) -> None:
        took = max(now - self._begin, 1e-3)
        left = (self.total - self.before - self.done) * took / max(self.done, 1)
        text = (
            f"{self.before + self.done}/{self.total} missions, {self.simulated_s / took:.0f} x real time, "
            f"{left:.0f} s left" + (f", {self.errors} failed" if self.errors else "")
        )
        print(
            f"\r\033[K{text}" if self._live else text,
            end="" if self._live else "\n",
            file=self._stream,
            flush=True,
        )

    def close(self) -> None:
        """Say the last figure."""
        self._say(time.monotonic())
        if self._live:
            print(file=self._stream, flush=True)
