# SPDX-License-Identifier: MIT
"""Rule: whatever stands in the way, the robot gets to its goal or says that it does not, and then stands still.

`PAIRS` and `GOALS` are made from their seed: `pytest -k 'goal and 17'` runs goal 17 again.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
import pytest

from hil_sim.bench.journey_worlds import NO_WAY, place_of
from hil_sim.bench.worlds import make_world
from hil_sim.sil import Mission, Sil

SETS: Final = ("doors", "corridors", "bends", "dead-ends", "pairs")
EACH: Final = 4
MANY: Final = 8
SPLIT: Final = 30
"""No bench has its worlds."""
LIMIT_S: Final = 1200.0
MORE_S: Final = 3.0
"""After the end, in which it comes to rest."""
WORLDS: Final = ("gen-room", "gen-office", "gen-clutter", "gen-corridor")
REST_MM: Final = 1.0
REASONS: Final = ("NO_WAY", "WAITING", "FAILURE_STATE", "ODOMETRY_LOST")
NEAR: Final = 4
"""Events before the end, among which is its reason."""
FEW_GOALS: Final = 8
SHARDS: Final = 8
MISSED: Final = 4
"""One in so many at most; the bench of journeys has the shares."""


class End(NamedTuple):
    """How a mission ended: in its own words, where, and how far it moved within MORE_S after MORE_S."""

    what: str
    reason: str
    t_s: float
    goal_mm: float
    crept_mm: float


def _drive(mission: Mission) -> End:
    sil = Sil(mission)
    sil.run_until(mission.limit_s)
    end_s = sil.now_ms / 1000
    names = [event.name for event in sil.events]
    ends = [name for name in names if name in ("GOAL_REACHED", "MISSION_FAILED")]
    before = names[: names.index(ends[0])] if ends else names
    reasons = [name for name in before[-NEAR:] if name in REASONS]
    goal_mm = sil.outcome().goal_mm
    places = []
    for more in (MORE_S, 2 * MORE_S):
        while sil.now_ms < (end_s + more) * 1000:
            sil.step()
        places.append((sil.robot.chassis.x, sil.robot.chassis.y))
    return End(ends[0] if ends else "", "".join(reasons[-1:]), end_s, goal_mm, math.dist(*places))


def _set_mission(name: str, seed: int) -> Mission:
    place = place_of(f"{name}-{seed}", (SPLIT, seed))
    x, y, heading = place.begins
    return Mission(place.path, place.course, (x, y, heading), seed=seed, limit_s=LIMIT_S)


def _ends(name: str, count: int) -> list[End]:
    return [_drive(_set_mission(name, seed)) for seed in range(count)]


def _drive_goal(seed: int, folder: Path) -> End:
    """A goal anywhere in a small world, also in a wall or where nobody gets to; every fourth with a dead sonar."""
    rng = np.random.default_rng([SPLIT, seed])
    world, _, path = make_world(WORLDS[seed % len(WORLDS)], (SPLIT, seed), folder)
    low_x, low_y, high_x, high_y = world.bounds
    goal = (float(rng.uniform(low_x, high_x)), float(rng.uniform(low_y, high_y)))
    faults = (f"off:{int(rng.integers(1, 7))}@3s",) if seed % 4 == 3 else ()
    return _drive(Mission(str(path), (goal,), seed=seed, faults=faults, limit_s=LIMIT_S))


def _check(end: End, which: str) -> None:
    assert end.what, f"{which}: no end after {end.t_s:.0f} s, {end.goal_mm:.0f} mm from the goal"
    assert end.what == "GOAL_REACHED" or end.reason, f"{which}: gave up without a reason"
    assert end.crept_mm < REST_MM, f"{which}: moved {end.crept_mm:.0f} mm after {end.what}"


def _check_goals(seeds: range, folder: Path) -> None:
    for seed in seeds:
        _check(_drive_goal(seed, folder), f"goal {seed}")


@pytest.mark.parametrize(
    "count", [pytest.param(EACH, marks=pytest.mark.soak), pytest.param(MANY, marks=pytest.mark.wide)]
)
@pytest.mark.parametrize("name", SETS)
def test_the_robot_gets_round_what_stands_in_the_way(name: str, count: int) -> None:
    ends = _ends(name, count)
    for seed, end in enumerate(ends):
        _check(end, f"{name} {seed}")
    reached = sum(end.what == "GOAL_REACHED" for end in ends)
    assert reached >= count - count // MISSED, f"{name}: {[end.what for end in ends]}"


@pytest.mark.soak
def test_a_goal_behind_walls_is_given_up() -> None:
    for seed, end in enumerate(_ends(NO_WAY, EACH)):
        _check(end, f"{NO_WAY} {seed}")
        assert (end.what, end.reason) == ("MISSION_FAILED", "NO_WAY"), f"{NO_WAY} {seed}: {end}"


def test_every_random_goal_ends(tmp_path: Path) -> None:
    _check_goals(range(FEW_GOALS), tmp_path)


@pytest.mark.wide
@pytest.mark.parametrize("shard", range(SHARDS))
def test_a_thousand_random_goals_end(tmp_path: Path, shard: int) -> None:
    _check_goals(range(FEW_GOALS + shard, 1000, SHARDS), tmp_path)
