# SPDX-License-Identifier: MIT
"""S4 by the truth: after sweeps and looks the robot looks where it looked before."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

HOME_DEG: Final = 2.0
HOME_PART: Final = 0.006
"""Of the degrees turned, what odometry may be off by: three standard deviations."""
SAME_DEG: Final = 3.0
_SWEEPS: Final = "SWEEPING"
_LOOKS: Final = "VERIFYING"
_NEXT: Final = ("DRIVING", "STEPPING", _SWEEPS)
_FORGIVES: Final = ("TURN_BLOCKED", "BACKING", "WAITING", "AVOIDING", "BUMPER", "REVERSED", "STALL")
"""After one of these the robot goes on from whatever heading it has."""


def off_deg(a: float, b: float) -> float:
    """Return by how much two headings differ."""
    return abs((a - b + 180.0) % 360.0 - 180.0)


class Home:
    """Follows headings at rest through sweeps and looks; each question returns what is wrong, or nothing.

    A sweep may begin with a turn to the leg's bearing, which is no part of it. The first turn of the sweep itself is
    the first rotation of the plan.
    """

    def __init__(self) -> None:
        self._rests: list[float] = []
        self._mode = ""
        self._looked_from: float | None = None
        self._begins = False
        self._turned_deg = 0.0
        self._plan: list[int] = []
        self._replanned = False

    def hear(self, name: str, value: int, heading: float) -> str | None:
        """Take an event of the fault manager."""
        if name == "PLAN":
            self._plan = []
            self._replanned = self._mode == _SWEEPS
        elif name == "PLAN_ROTATION":
            self._plan.append(value)
        elif name in _FORGIVES:
            self._looked_from = None
            self._begins = False
            self._rests.clear()
        elif name == "SWEEP":
            return self._after_sweep(heading)
        return None

    def change(self, mode: str, heading: float) -> str | None:
        """Take a change of the mode."""
        before, self._mode = self._mode, mode
        wrong = None
        if mode in _NEXT and before != _SWEEPS and self._looked_from is not None:
            wrong = self._judge([self._looked_from], heading, "after looks")
            self._looked_from = None
        self._begins = mode == _LOOKS and self._looked_from is None and before != _SWEEPS
        if mode in (_SWEEPS, _LOOKS):
            self._rests, self._turned_deg = [heading], 0.0
        return wrong

    def still(self, heading: float) -> None:
        """The robot stands: looks begin from here, not from where it was while it braked."""
        if self._begins:
            self._looked_from = heading
            self._begins = False

    def rest(self, heading: float) -> None:
        """A turn on the spot has ended."""
        if self._rests:
            self._turned_deg += off_deg(heading, self._rests[-1])
            self._rests.append(heading)

    def _after_sweep(self, heading: float) -> str | None:
        rests, self._rests = self._rests, [heading]
        replanned, self._replanned = self._replanned, False
        if len(rests) < 2 or not self._plan:
            return None
        if replanned:  # it began with a turn that is no rotation of the present plan
            return self._judge(rests[:2], heading, "after a sweep")
        first = self._plan[0]
        starts = [k for k in (0, 1) if k + 1 < len(rests) and self._is_turn(rests[k], rests[k + 1], first)]
        return self._judge([rests[k] for k in starts] or [rests[0]], heading, "after a sweep")

    @staticmethod
    def _is_turn(before: float, after: float, by: int) -> bool:
        return off_deg(before + by, after) <= SAME_DEG

    def _judge(self, bases: Iterable[float], heading: float, when: str) -> str | None:
        off = min(off_deg(heading, base) for base in bases)
        return f"{off:.1f} degrees off {when}" if off > HOME_DEG + HOME_PART * self._turned_deg else None
