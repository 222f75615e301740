# SPDX-License-Identifier: MIT
"""Made-up records of journeys for the tests of the bench."""

from __future__ import annotations

import os
import signal
from typing import Any

from hil_sim.bench.journey import parse_id
from hil_sim.bench.journey_track import head


def journey(name: str = "argus/judge/rooms/lab/1", **more: Any) -> dict[str, Any]:
    """Return the record of a journey of 45 m that arrived after 300 s."""
    plain: dict[str, Any] = {
        "t_s": 300.0,
        "driving_s": 280.0,
        "driven_mm": 46_000.0,
        "reached": True,
        "goal_mm": 40.0,
        "faults": [],
        "faulty": [],
        "false_disables": [],
        "false_names": [],
        "collisions": [],
        "struck": 0,
        "met_ahead": 0,
        "walked_into": 0,
        "attributable": False,
        "undetected": False,
        "verifications": 4,
        "looking_s": 10.0,
        "stop_commands": 3,
        "digest": "0",
        "course_mm": 45_000.0,
        "progress_mm": 45_000.0,
        "word": "reached",
        "truly": True,
        "odometry_off_mm": 30.0,
        "stops": 12,
        "looks": 3,
        "turned_deg": 1500.0,
        "closest_mm": 120.0,
        "early_mm": 46_000.0,
        "modes_s": {"DRIVING": 290.0, "VERIFYING": 10.0},
        "path": [(0, 0), (1000, 0), (1000, 500)],
        "stops_at": [(1000, 0)],
        "looks_at": [(500, 0)],
        "energy_j": 4500.0,
        "limit_s": 900.0,
        "wall_s": 1.0,
    }
    return head(parse_id(name)) | plain | more


def with_ideal(name: str = "argus/judge/rooms/lab/1", **more: Any) -> list[dict[str, Any]]:
    """Return a journey and its ideal, which takes 150 s."""
    record = journey(name, **more)
    ideal = journey(record["ideal"], t_s=150.0, driving_s=145.0, looking_s=0.0, looks=0, looks_at=[])
    return [ideal, record]


DEADLY = "argus/tune/rooms/lab/2"


def deadly(name: str) -> dict[str, Any]:
    """Run no mission; one of them kills its process each time."""
    if name == DEADLY:
        os.kill(os.getpid(), signal.SIGKILL)
    return journey(name)
