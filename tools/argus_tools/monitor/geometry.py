# SPDX-License-Identifier: MIT
"""What the page draws that does not change: the robot's body and sonars, and the walls of an emulated world."""

from __future__ import annotations

import math
from typing import Any, Final

from hil_sim.errors import SimError
from hil_sim.tables.robot import RobotTable, robot_table
from hil_sim.world.model import Pose, World

WALLS_MAX: Final = 4000


def robot_of(subclass: str) -> RobotTable:
    """Return the table of a robot; of the default one where the subclass is not known."""
    try:
        return robot_table(subclass.lower() or "p3dx-sh")
    except SimError:
        return robot_table()


def robot_message(table: RobotTable) -> dict[str, Any]:
    """What a page needs to draw a robot; mm and degrees in its own frame, x ahead, y left."""
    body = table.body
    return {
        "subclass": table.subclass,
        "front_mm": body.front_mm,
        "rear_mm": body.rear_mm,
        "half_mm": body.half_mm,
        "swing_mm": body.swing_mm,
        "sonars": [
            {"x_mm": mount.x_mm, "y_mm": mount.y_mm, "deg": mount.heading_deg, "role": mount.role}
            for mount in table.mounts
        ],
        "forward": list(table.forward),
    }


def walls_of(world: World, start: Pose) -> list[list[int]]:
    """Return the solids of a world as a robot that started there has them: it began at 0, 0, looking along x."""
    turn = math.radians(-start.heading_deg)
    cos, sin = math.cos(turn), math.sin(turn)

    def seen(x: float, y: float) -> tuple[int, int]:
        dx, dy = x - start.x_mm, y - start.y_mm
        return round(dx * cos - dy * sin), round(dx * sin + dy * cos)

    return [[*seen(x1, y1), *seen(x2, y2)] for x1, y1, x2, y2 in world.segments[:WALLS_MAX].tolist()]
