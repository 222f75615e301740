# SPDX-License-Identifier: MIT
"""What living sonars have truly looked at: of the ground ahead, and of the bearings round a place."""

from __future__ import annotations

import math
from typing import Final

import numpy as np
import numpy.typing as npt

from hil_sim.robot.interfaces import SonarReading
from hil_sim.tables.robot import RobotTable
from hil_sim.world.model import Pose

TRUST_MM: Final = 2000.0
"""What lies farther off may give no echo."""
LATELY_MS: Final = 60_000.0
_CONE_SLOPE: Final = math.tan(math.radians(15.0))
_BESIDE_MM: Final = 40.0
"""So far beside the cone a thing that is near is heard as well."""
_RAYS: Final = 1024
_SAME_PLACE_MM: Final = 40.0
_ALONG_DEG: Final = 4.0
"""A sonar that looks within this of a bearing looks along it."""

Floats = npt.NDArray[np.float64]


class Ground:
    """Rays of readings that no fault has touched, in a ring of the last ones."""

    def __init__(self, table: RobotTable) -> None:
        self._mounts = table.mounts
        self._rays: Floats = np.zeros((_RAYS, 6))
        self._rays[:, 5] = -math.inf
        self._next = 0
        self._axes: list[float] = []
        self._place: Pose | None = None

    def hear(self, reading: SonarReading, pose: Pose, *, at_rest: bool) -> None:
        """Take a reading of a sonar that lives, and where the robot truly was."""
        mount = self._mounts[reading.number]
        heading = math.radians(pose.heading_deg)
        c, s = math.cos(heading), math.sin(heading)
        x = pose.x_mm + mount.x_mm * c - mount.y_mm * s
        y = pose.y_mm + mount.x_mm * s + mount.y_mm * c
        axis = heading + math.radians(mount.heading_deg)
        free = min(float(reading.true_mm), TRUST_MM)
        self._rays[self._next] = x, y, math.cos(axis), math.sin(axis), free, reading.t_ms
        self._next = (self._next + 1) % _RAYS
        if not at_rest or self._place is None or _way_mm(self._place, pose) > _SAME_PLACE_MM:
            self._axes.clear()
            self._place = pose
        if at_rest:
            self._axes.append(math.degrees(axis))

    def is_seen(self, points: Floats, now_ms: float) -> bool:
        """Whether each of these places lay in the cone of a living sonar, nearer than its echo."""
        x, y, c, s, free, _ = self._rays[self._rays[:, 5] >= now_ms - LATELY_MS].T
        dx, dy = points[:, :1] - x, points[:, 1:] - y
        along, beside = dx * c + dy * s, np.abs(dy * c - dx * s)
        shown = (along > 0) & (along < free) & (beside <= along * _CONE_SLOPE + _BESIDE_MM)
        return bool(shown.any(axis=1).all())

    def looked_along(self, bearings_deg: list[float], pose: Pose) -> bool:
        """Whether from this very place, at rest, a living sonar has looked along each bearing."""
        if self._place is None or _way_mm(self._place, pose) > _SAME_PLACE_MM:
            return False
        axes = np.array(self._axes)
        return all(
            bool((np.abs((axes - bearing + 180.0) % 360.0 - 180.0) <= _ALONG_DEG).any())
            for bearing in bearings_deg
        )


def _way_mm(a: Pose, b: Pose) -> float:
    return math.hypot(a.x_mm - b.x_mm, a.y_mm - b.y_mm)
