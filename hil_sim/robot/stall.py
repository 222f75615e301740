# SPDX-License-Identifier: MIT
"""The stall monitor: wheels that do not turn though they should lose their power for a while."""

from __future__ import annotations

from hil_sim.arcos import DEFAULT, TIMING
from hil_sim.robot.state import StallState
from hil_sim.world.step import STEP_MS


class StallMonitor(StallState):
    """Which wheels are stalled now, and which were since the last SIP."""

    def is_relaxing(self, now_ms: int) -> bool:
        """The wheels are without drive after a stall."""
        return now_ms < self._relax_until_ms

    def set(self, left: bool, right: bool) -> None:
        """Say which wheels are stalled now."""
        self.left, self.right = left, right
        self._seen_left |= left
        self._seen_right |= right

    def clear(self) -> None:
        """Nothing drives and nothing is stalled."""
        self.left = self.right = False

    def free(self) -> None:
        """A whole step was possible."""
        self._blocked_ms = 0

    def block(self, now_ms: int, left: bool, right: bool) -> None:
        """A step was not possible; after a while the wheels that wanted to turn are stalled."""
        self._blocked_ms += STEP_MS
        if self._blocked_ms >= TIMING["STALL_TIME_MS"]:
            self._blocked_ms = 0
            self._relax_until_ms = now_ms + DEFAULT["STALLCOUNT_MS"]
            self.set(left, right)

    def take(self) -> tuple[bool, bool]:
        """Return what was stalled since the last call, left and right."""
        seen = self._seen_left or self.left, self._seen_right or self.right
        self._seen_left = self._seen_right = False
        return seen
