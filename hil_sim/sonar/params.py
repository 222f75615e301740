# SPDX-License-Identifier: MIT
"""How the sonars behave, where they are, and what one reading is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

from hil_sim.tables import load
from hil_sim.tables.robot import DEFAULT_ROBOT, Mount
from hil_sim.world.model import Pose

# The same for all robots that there is a table of.
_TABLE: Final[dict[str, Any]] = load(f"robots/{DEFAULT_ROBOT}")["sonar"]
MIN_MM: Final[int] = _TABLE["min_mm"]
NO_ECHO_MM: Final[int] = _TABLE["no_echo_mm"]


def transducer_pose(mount: Mount, robot: Pose) -> Pose:
    """Return where a sonar of a robot is in the world, and where it looks; degrees as they add up."""
    heading = math.radians(robot.heading_deg)
    c, s = math.cos(heading), math.sin(heading)
    return Pose(
        robot.x_mm + mount.x_mm * c - mount.y_mm * s,
        robot.y_mm + mount.x_mm * s + mount.y_mm * c,
        robot.heading_deg + mount.heading_deg,
    )


@dataclass(frozen=True)
class SonarParams:
    """How the sonar behaves; the model and the source of the defaults are in docs/worlds.md.

    noise_mm, noise_part: standard deviation of the range noise: fixed part, and part of the range.
    crosstalk: probability that a ping hears another one and reads too short.
    specular: False makes every surface scatter, whatever its roughness.
    cone_deg: full width of the beam. edge_db: loss at the edge of the cone, there and back.
    margin_db: loss at which an echo is no longer heard. air_db_m: loss for each metre of range that the receiver's gain
    does not make up. mirror_db_deg2: loss of a smooth surface for each squared degree of incidence.
    side_lobe_db: loss of what is heard beside the cone, there and back, 0 for deaf; side_lobe_deg: full width of that.
    corner_db, tip_db: loss at an inner corner and at an edge or end, against a square-on wall.
    """

    noise_mm: float = 5.0
    noise_part: float = 0.002
    crosstalk: float = 0.01
    specular: bool = True
    cone_deg: float = float(_TABLE["cone_deg"])
    edge_db: float = 20.0
    margin_db: float = 30.0
    air_db_m: float = 2.0
    mirror_db_deg2: float = 0.24
    corner_db: float = 3.0
    tip_db: float = 18.0
    side_lobe_db: float = 0.0
    side_lobe_deg: float = 80.0


class Reading(NamedTuple):
    """One ping's result. `t_ms`: when its echo, or its time-out, was in.

    true_mm: what the model gives without noise, crosstalk and fault. fault: the fault kind that changed it.
    """

    t_ms: float
    number: int
    range_mm: int
    true_mm: int
    fault: str | None
