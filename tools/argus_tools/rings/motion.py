# SPDX-License-Identifier: MIT
"""Where a robot is and how it moves, in metres and radians, and where it is a moment later."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

AHEAD_MOST_S: Final = 0.3
"""Odometry older than this is not carried on: nothing says how the robot moved."""

SINCE_MOST_S: Final = 1.0


@dataclass(frozen=True)
class Motion:
    """Position, heading, and the speeds along and about; REP 103: x ahead, y left, counter-clockwise."""

    x_m: float = 0.0
    y_m: float = 0.0
    heading_rad: float = 0.0
    speed_m_s: float = 0.0
    turn_rad_s: float = 0.0

    def after(self, passed_s: float) -> Motion:
        """Return where it is that much later, at the same speeds."""
        passed_s = min(max(0.0, passed_s), AHEAD_MOST_S)
        middle = self.heading_rad + self.turn_rad_s * passed_s / 2
        way = self.speed_m_s * passed_s
        return replace(
            self,
            x_m=self.x_m + way * math.cos(middle),
            y_m=self.y_m + way * math.sin(middle),
            heading_rad=self.heading_rad + self.turn_rad_s * passed_s,
        )

    def since(self, before: Motion, passed_s: float) -> Motion:
        """Return it with the speeds that brought it here from an earlier place; at rest where that is long ago."""
        if not 0 < passed_s < SINCE_MOST_S:
            return self
        turned = math.remainder(self.heading_rad - before.heading_rad, math.tau)
        middle = before.heading_rad + turned / 2
        along = (self.x_m - before.x_m) * math.cos(middle) + (self.y_m - before.y_m) * math.sin(middle)
        return replace(self, speed_m_s=along / passed_s, turn_rad_s=turned / passed_s)
