# SPDX-License-Identifier: MIT
"""Worlds of the HIL tests: rough, and so wide that no edge sonar is disparate without a reason."""

from __future__ import annotations

import math
from typing import Any, Final

from hil_sim.tables.robot import robot_table

START: Final = [0, 0, 0]
BOX_MM: Final = 200


def hall(
    length_mm: float = 2700, half_width_mm: float = 2900, behind_mm: float = 1000, **more: Any
) -> dict[str, Any]:
    """A rough room, the start facing its far wall; front readings stay below 4 m, so that 5000 is a fault."""
    corners = [
        [-behind_mm, -half_width_mm],
        [length_mm, -half_width_mm],
        [length_mm, half_width_mm],
        [-behind_mm, half_width_mm],
    ]
    return {"start": START, "roughness": 1.0, "walls": [{"points": corners, "closed": True}], **more}


def hall_with_box(x_mm: float, sonar: int) -> dict[str, Any]:
    """The hall with a box in the way, which comes onto the axis of one of sonars 1 to 6 when it is near."""
    pose = robot_table().mounts[sonar]
    range_mm = 200 if sonar in (1, 6) else 250
    y_mm = pose.y_mm + range_mm * math.sin(math.radians(pose.heading_deg))
    return hall(boxes=[{"centre": [x_mm, round(y_mm)], "size": [BOX_MM, BOX_MM]}])
