# SPDX-License-Identifier: MIT
"""One direction of a serial line in virtual time."""

from __future__ import annotations

from collections import deque
from typing import Final

from hil_sim.arcos import TIMING

_BITS: Final = TIMING["BITS_PER_BYTE"]
_GRAIN_MS: Final = 4.0
"""Bytes on a wire are handed over at least this often, and at the end of what is being sent."""


class Wire:
    """One direction of a serial line in virtual time: bytes go in at once, come out at 10 bit times each."""

    def __init__(self, baud: int) -> None:
        self.baud = baud
        self.length = 0
        self._runs: deque[tuple[bytearray, int, float]] = deque()
        self._free_ms = 0.0

    @property
    def byte_ms(self) -> float:
        """Time one byte takes."""
        return _BITS * 1000 / self.baud

    @property
    def backlog_ms(self) -> float:
        """Time the bytes inside still take."""
        return self.length * self.byte_ms

    def push(self, data: bytes, now_ms: float, tag: int = 0) -> None:
        """Put bytes on the line; `tag` comes out with them (the sender's rate)."""
        if data:
            self._runs.append((bytearray(data), tag, now_ms))
            self.length += len(data)

    def _next_ms(self) -> float:
        """When the first byte inside is complete."""
        return max(self._runs[0][2], self._free_ms) + self.byte_ms

    def pop(self, now_ms: float) -> list[tuple[bytes, int]]:
        """Return what has arrived by now, in runs of one tag."""
        out: list[tuple[bytes, int]] = []
        now_ms += 1e-6
        while self._runs and (first_ms := self._next_ms()) <= now_ms:
            run, tag, _ = self._runs[0]
            count = min(len(run), 1 + int((now_ms - first_ms) / self.byte_ms))
            out.append((bytes(run[:count]), tag))
            del run[:count]
            if not run:
                self._runs.popleft()
            self.length -= count
            self._free_ms = first_ms + (count - 1) * self.byte_ms
        return out

    def due_ms(self) -> float | None:
        """When `pop` is worth calling: a grain from the next byte, or when the run's last byte is through."""
        if not self._runs:
            return None
        first_ms = self._next_ms()
        return first_ms + min(_GRAIN_MS, (len(self._runs[0][0]) - 1) * self.byte_ms)
