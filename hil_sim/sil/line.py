# SPDX-License-Identifier: MIT
"""One direction of a serial line, a packet at a time."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator
from typing import Final, NamedTuple

from hil_sim.arcos import TIMING

_BACKLOG_MS: Final = 200.0


class Line:
    """One direction of a serial line: each packet is handed over when its last bit is through."""

    def __init__(self, baud: int) -> None:
        self.byte_ms = TIMING["BITS_PER_BYTE"] * 1000 / baud
        self.held: deque[tuple[float, bytes]] = deque()
        self.free_ms = 0.0

    def push(self, data: bytes, now_ms: float) -> None:
        """Put a packet on the line; one that would wait too long is lost, as by a robot out of buffers."""
        if self.free_ms - now_ms > _BACKLOG_MS:
            return
        self.free_ms = max(self.free_ms, now_ms) + len(data) * self.byte_ms
        self.held.append((self.free_ms, data))

    def pop(self, now_ms: float) -> Iterator[bytes]:
        """Yield the packets that are through, oldest first."""
        while self.held and self.held[0][0] <= now_ms:
            yield self.held.popleft()[1]

    @property
    def due_ms(self) -> float:
        """When the next packet is through."""
        return self.held[0][0] if self.held else math.inf


class Packet(NamedTuple):
    """One packet as it was handed over: `to_robot` or to the fault manager."""

    t_ms: float
    to_robot: bool
    data: bytes
