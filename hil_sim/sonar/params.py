# SPDX-License-Identifier: MIT
"""How the sonars behave, where they are, and what one reading is."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

from hil_sim.tables import load
from hil_sim.world.model import Pose

_TABLE: Final[dict[str, Any]] = load("robots/p3dx-sh")["sonar"]
MIN_MM: Final[int] = _TABLE["min_mm"]
NO_ECHO_MM: Final[int] = _TABLE["no_echo_mm"]
CYCLE_MS: Final[int] = _TABLE["cycle_ms"]
PER_ARRAY: Final[int] = _TABLE["transducers_per_array"]
FITTED_ARRAYS: Final[int] = _TABLE["arrays"]
ARRAYS: Final = 4
"""Arrays that ARCOS knows; a P3-DX has the first two."""
SONAR_POSES: Final[tuple[Pose, ...]] = tuple(
    Pose(float(p["x_mm"]), float(p["y_mm"]), float(p["heading_deg"])) for p in _TABLE["pose"]
)


def transducer_pose(number: int, robot: Pose) -> Pose:
    """Return where sonar 0 to 15 of a robot is in the world, and where it looks; degrees as they add up."""
    mount = SONAR_POSES[number]
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


class Reading(NamedTuple):
    """One ping's result. `t_ms`: when its echo, or its time-out, was in.

    true_mm: what the model gives without noise, crosstalk and fault. fault: the fault kind that changed it.
    """

    t_ms: float
    number: int
    range_mm: int
    true_mm: int
    fault: str | None
