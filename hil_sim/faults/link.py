# SPDX-License-Identifier: MIT
"""Disturbances of the link between robot and client: dropped, corrupted, delayed data, and a cut cable."""

from __future__ import annotations

import random
from collections import deque
from collections.abc import Iterable

from hil_sim.faults.kinds import LinkFault
from hil_sim.record.truth import Log


def _active(fault: LinkFault, now_ms: float) -> bool:
    return fault.start_ms <= now_ms and (fault.end_ms is None or now_ms < fault.end_ms)


class LinkFaults:
    """Applies link faults to what passes in each direction; seeded."""

    def __init__(self, faults: Iterable[LinkFault], seed: int = 0, log: Log | None = None) -> None:
        self._faults = list(faults)
        self._on = [False] * len(self._faults)
        self._rng = random.Random(f"link {seed}")
        self._log = log
        self._held: dict[str, deque[tuple[float, bytes]]] = {"to_client": deque(), "to_robot": deque()}

    def update(self, now_ms: float) -> None:
        """Note which faults begin and end."""
        for k, fault in enumerate(self._faults):
            active = _active(fault, now_ms)
            if active != self._on[k]:
                self._on[k] = active
                if self._log is not None:
                    fields = {"kind": fault.kind, "direction": fault.direction, "on": active}
                    self._log("link", {"t_s": round(now_ms / 1000, 3), **fields})

    def push(self, data: bytes, now_ms: float, direction: str) -> None:
        """Let data enter the link."""
        delay_ms = 0.0
        for fault in self._faults:
            if not _active(fault, now_ms) or fault.direction not in ("both", direction):
                continue
            if fault.kind == "cut":
                return
            if fault.kind == "delay":
                delay_ms += fault.delay_ms
            elif self._rng.random() < fault.probability:
                if fault.kind == "drop":
                    return
                where = self._rng.randrange(len(data))
                data = data[:where] + bytes((data[where] ^ 1 << self._rng.randrange(8),)) + data[where + 1 :]
        queue = self._held[direction]
        after = queue[-1][0] if queue else 0.0
        queue.append((max(now_ms + delay_ms, after), data))

    def pop(self, now_ms: float, direction: str) -> list[bytes]:
        """Return what has come through."""
        queue, out = self._held[direction], []
        while queue and queue[0][0] <= now_ms:
            out.append(queue.popleft()[1])
        return out

    def due_ms(self) -> float | None:
        """When something held comes through."""
        times = [queue[0][0] for queue in self._held.values() if queue]
        return min(times) if times else None
