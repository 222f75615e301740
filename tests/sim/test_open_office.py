# SPDX-License-Identifier: MIT
"""Rule under attack: the demonstration's office is what it says, and there, too, diagnosis equals injection.

Glass at grazing angles and open floor take echoes away from healthy sonars; virtual time, a few seeds.
"""

from __future__ import annotations

import itertools
import math
import multiprocessing
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor

import numpy as np
import pytest

from hil_sim.scenario.scenario import load_scenario
from hil_sim.sil import Mission, Outcome, Sighting, Sil, run
from hil_sim.sonar.params import NO_ECHO_MM
from hil_sim.tables.robot import robot_table
from hil_sim.world.files import load_world

SCENARIO = load_scenario("open-office")
COURSE = tuple(SCENARIO.course)
FAULTS = ("off:3@travelled>600", "wrong:6@travelled>1400:scale=0.5")
AHEAD = range(1, 7)
SOLIDS = np.asarray(load_world("open-office").segments, dtype=float).T


def along_axis_mm(x_mm: float, y_mm: float, deg: float) -> float:
    """How far it is along a bearing to the nearest solid of the world; inf: to none."""
    x1, y1, x2, y2 = SOLIDS
    c, s = math.cos(math.radians(deg)), math.sin(math.radians(deg))
    across = c * (y2 - y1) - s * (x2 - x1)
    with np.errstate(divide="ignore", invalid="ignore"):
        way = ((x1 - x_mm) * (y2 - y1) - (y1 - y_mm) * (x2 - x1)) / across
        part = ((x1 - x_mm) * s - (y1 - y_mm) * c) / across
    return float(np.min(way, where=(way > 0) & (part >= 0) & (part <= 1), initial=np.inf))


def test_open_floor_and_glass_take_echoes_away() -> None:
    seen: Counter[str] = Counter()

    def note(_: Sil, sighting: Sighting) -> None:
        for reading in sighting.readings:
            if reading.number in AHEAD:
                mount, pose = robot_table().mounts[reading.number], sighting.pose
                turn = math.radians(pose.heading_deg)
                x = pose.x_mm + mount.x_mm * math.cos(turn) - mount.y_mm * math.sin(turn)
                y = pose.y_mm + mount.x_mm * math.sin(turn) + mount.y_mm * math.cos(turn)
                echo = reading.true_mm < NO_ECHO_MM
                near = along_axis_mm(x, y, pose.heading_deg + mount.heading_deg) < NO_ECHO_MM
                seen["echo" if echo else ("glass" if near else "open")] += 1

    there_and_back = (*COURSE, *reversed(COURSE[:-1]), (0.0, 0.0))
    run(Mission("open-office", there_and_back, sonar={"crosstalk": 0.0}, limit_s=60), trace=note)
    total = sum(seen.values())
    assert seen["open"] >= 0.03 * total, seen
    assert seen["glass"] >= 0.03 * total, seen


def _drive(faults: tuple[str, ...], seed: int, physics: str) -> Outcome:
    """Return what comes of the demonstration's course with such faults."""
    sonar = {"crosstalk": 0.0}
    mission = Mission(
        "open-office", COURSE, faults=faults, seed=seed, sonar=sonar, physics=physics, limit_s=120
    )
    return run(mission)


def _out(seen: Outcome) -> dict[int, str]:
    """Return the sonars that are given up in the end, and as what."""
    return {number: kind for number, (health, kind) in enumerate(seen.final) if health == "DISABLED"}


@pytest.mark.parametrize(("seed", "physics"), [(1, ""), (2, ""), (105, "rough-day"), (107, "rough-day")])
def test_the_faults_are_told_and_the_goal_is_reached(seed: int, physics: str) -> None:
    """Of the demonstration's 60 s a fifth stays in hand: sonar 6 looks late in one turn and wrong in the next."""
    seen = _drive(FAULTS, seed, physics)
    assert seen.reached
    assert seen.t_s < 48.0
    assert not seen.collisions
    out = _out(seen)
    assert out == {3: "off", 6: "wrong"}
    for number, states in enumerate(seen.health):
        assert number in out or all(health != "DISABLED" for _, health, _ in states), f"sonar {number}"


def _told(job: tuple[int, int, int, str]) -> tuple[tuple[int, int, int, str], bool, str]:
    """Drive once; whether exactly the two faults were told within 60 s, and what must never be."""
    dead, wrong, seed, physics = job
    faults = (f"off:{dead}@travelled>600", f"wrong:{wrong}@travelled>1400:scale=0.5")
    seen = _drive(faults, seed, physics)
    told = _out(seen) == {dead: "off", wrong: "wrong"}
    healthy = [n for n, states in enumerate(seen.health) if n not in (dead, wrong) and _ever_out(states)]
    worst = f"{job}: hit {len(seen.collisions)}, healthy ones given up: {healthy}"
    return job, told and seen.reached and seen.t_s < 60.0, worst if seen.collisions or healthy else ""


def _ever_out(states: Sequence[tuple[float, str, str]]) -> bool:
    return any(health == "DISABLED" for _, health, _ in states)


@pytest.mark.wide
@pytest.mark.parametrize("physics", ["", "rough-day"])
@pytest.mark.parametrize("jobs", ["pairs", "seeds"])
def test_nine_of_ten_pairs_and_seeds_are_told(jobs: str, physics: str) -> None:
    pairs = [(a, b, 1, physics) for a, b in itertools.permutations(AHEAD, 2)]
    seeds = [(3, 6, seed, physics) for seed in range(1, 21)]
    with ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as pool:
        driven = list(pool.map(_told, pairs if jobs == "pairs" else seeds))
    assert not [worst for _, _, worst in driven if worst]
    missed = [job for job, told, _ in driven if not told]
    assert len(missed) <= len(driven) // 10, missed


@pytest.mark.parametrize("seed", [2, 4, 8])
def test_a_wrong_one_is_proved_beside_one_that_died_later(seed: int) -> None:
    """At the goal the silent one is in the way of its proof, and no suspect of most looks."""
    seen = _drive(("wrong:4@travelled>600:scale=0.5", "off:1@travelled>1400"), seed, "")
    assert _out(seen) == {4: "wrong", 1: "off"}
    assert seen.reached
