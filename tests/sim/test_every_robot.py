# SPDX-License-Identifier: MIT
"""Rule: with the default settings each known robot reaches what a P3-DX reaches, healthy or with one sonar dead."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from hil_sim.bench.course import make_course, make_field
from hil_sim.sil import Mission, Outcome, run
from hil_sim.tables import robots
from hil_sim.tables.robot import DEFAULT_ROBOT
from hil_sim.world.files import load_world

OTHERS = [name for name in robots() if name != DEFAULT_ROBOT]
WORLDS = ("office", "lab", "corridor")
COURSE_MM = 6000.0
LIMIT_S = 400.0
DEAD = 2
"""It looks ahead on each of them."""
AHEAD = (None, 1, 2, 3, 4, 6)
SEEDS = range(10, 16)


@cache
def driven(robot: str, world: str, dead: int | None, seed: int) -> Outcome:
    loaded = load_world(world)
    course = make_course(loaded, make_field(loaded), COURSE_MM, np.random.default_rng(seed))
    faults = () if dead is None else (f"off:{dead}@0s",)
    return run(Mission(world=world, robot=robot, course=course, faults=faults, seed=seed, limit_s=LIMIT_S))


def assert_as_far(robot: str, world: str, dead: int | None, seed: int) -> None:
    case = f"{robot} in {world}, dead: {dead}, seed {seed}"
    assert driven(DEFAULT_ROBOT, world, dead, seed).reached, f"no reference: {case}"
    outcome = driven(robot, world, dead, seed)
    told = {event.name for event in outcome.events}
    assert outcome.reached, f"{case}: {outcome.goal_mm:.0f} mm from the goal, {sorted(told)}"
    assert not outcome.collisions, case
    assert told.isdisjoint({"ROBOT_UNSAFE", "MISSION_FAILED"}), case


@pytest.mark.tour(6)
@pytest.mark.parametrize("dead", [None, DEAD])
@pytest.mark.parametrize("world", WORLDS)
@pytest.mark.parametrize("robot", OTHERS)
def test_it_reaches_what_a_p3dx_reaches(robot: str, world: str, dead: int | None) -> None:
    assert_as_far(robot, world, dead, SEEDS[0])


@pytest.mark.wide
@pytest.mark.parametrize("world", WORLDS)
@pytest.mark.parametrize("robot", OTHERS)
def test_it_reaches_all_that_a_p3dx_reaches(robot: str, world: str) -> None:
    for seed in SEEDS:
        for dead in AHEAD:
            if dead is None or dead < 6 or robot != "amigo-sh":
                assert_as_far(robot, world, dead, seed)
