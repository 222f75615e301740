# SPDX-License-Identifier: MIT
"""Rule: a robot that follows a course by an odometry that drifts hits nothing, and is at the goal when it thinks so."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from hil_sim.bench.course import make_field
from hil_sim.bench.journey_course import DRIFT_DEG_M, ROUGH_DRIFT_DEG_M, drift_course, length_mm
from hil_sim.bench.plan import world_of
from hil_sim.errors import SimError
from hil_sim.tables.robot import robot_table
from hil_sim.world.body import BodyModel
from hil_sim.world.files import load_world
from hil_sim.world.model import Pose, World

STEP_MM = 20.0
WORLDS = [("office", 1), ("lab", 2), ("corridor", 1), ("gen-room", 3), ("gen-hall", 1), ("gen-hall", 3)]


def course_of(
    name: str, seed: int, drift: float = DRIFT_DEG_M
) -> tuple[World, tuple[tuple[float, float], ...]]:
    world, field, _ = world_of(name, "tune", seed)
    return world, drift_course(world, field, np.random.default_rng(seed), drift)


def follow(start: Pose, course: tuple[tuple[float, float], ...], drift_deg_m: float) -> list[Pose]:
    """The true poses of a robot that drives straight to each point by an odometry blind to this drift, step by step."""
    x, y, turned = start.x_mm, start.y_mm, 0.0
    odo = (start.x_mm, start.y_mm)
    poses = [Pose(x, y, start.heading_deg)]
    for goal in course:
        heading = math.degrees(math.atan2(goal[1] - odo[1], goal[0] - odo[0]))
        steps = max(1, round(math.dist(odo, goal) / STEP_MM))
        step = math.dist(odo, goal) / steps
        for _ in range(steps):
            turned += drift_deg_m * step / 1000
            at = math.radians(heading + turned)
            x, y = x + step * math.cos(at), y + step * math.sin(at)
            poses.append(Pose(x, y, heading + turned))
        odo = goal
    return poses


@pytest.mark.tour(3, 6)
@pytest.mark.parametrize(("drift", "off_mm"), [(DRIFT_DEG_M, 90.0), (ROUGH_DRIFT_DEG_M, 400.0)])
@pytest.mark.parametrize(("name", "seed"), WORLDS)
def test_drift_leads_into_no_wall_and_cancels_at_the_goal(
    name: str, seed: int, drift: float, off_mm: float
) -> None:
    world, course = course_of(name, seed, drift)
    body = BodyModel(world, None, robot_table().body)
    assert length_mm(world.start[:2], course) > (42_000 if drift == DRIFT_DEG_M else 30_000), (name, seed)
    for part in (-1.0, -0.5, 0.0, 0.5, 1.0):
        poses = follow(world.start, course, part * drift)
        near = min(body.clearance_mm(pose) for pose in poses[::3])
        assert near > 100, (name, seed, part)
        # Of 150 mm the robot itself takes 60.
        assert math.dist(poses[-1][:2], course[-1]) < off_mm, (name, seed, part)


def test_the_same_seed_gives_the_same_course() -> None:
    assert course_of("lab", 3)[1] == course_of("lab", 3)[1] != course_of("lab", 4)[1]


def test_a_world_without_room_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "cell.yaml"
    path.write_text(
        "walls:\n  - {points: [[-600, -600], [600, -600], [600, 600], [-600, 600]], closed: true}\n"
    )
    world = load_world(str(path))
    with pytest.raises(SimError, match="cell: too little room"):
        drift_course(world, make_field(world), np.random.default_rng(1))
