# SPDX-License-Identifier: MIT
"""Rule: S1, S4, S5 and S7 hold by the truth at every tick of whatever is driven; a breach is found out."""

from __future__ import annotations

import numpy as np
import pytest

from hil_sim.experiment.cases import parse_id
from hil_sim.experiment.drive import run_case
from hil_sim.experiment.ground import Ground
from hil_sim.experiment.home import Home
from hil_sim.experiment.safety import Safety, watch
from hil_sim.sil import Mission, Sil
from hil_sim.sonar.params import Reading
from hil_sim.tables.robot import robot_table
from hil_sim.world.model import Pose

COURSE = ((1700.0, 0.0), (1700.0, 1550.0))


def told(sil: Sil, safety: Safety) -> str:
    """What reproduces it."""
    return f"{sil.mission.to_json()}: {safety.counts} {safety.breaches}"


@pytest.mark.tour(3)
@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize(
    ("profile", "faults"),
    [
        ("paper", ("off:3",)),
        ("paper", ("off:2+4+5",)),
        ("argus", ("off:3+4",)),
        ("argus", ("off:front@6s",)),
        ("argus", ("silent:1+2+3+5+6@5s",)),
    ],
)
def test_no_rule_is_broken(profile: str, faults: tuple[str, ...], seed: int) -> None:
    mission = Mission(
        "demo", COURSE, faults=faults, config={"profile": profile}, seed=seed, limit_s=60, stop_at_goal=True
    )
    sil = Sil(mission)
    safety = watch(sil)
    outcome = sil.run()
    assert not any(safety.counts.values()), told(sil, safety)
    assert not outcome.collisions, told(sil, safety)
    assert outcome.driven_mm > 500, told(sil, safety)
    assert 0 < safety.closest_mm < 3000, told(sil, safety)


@pytest.mark.tour(1)
@pytest.mark.parametrize("run", ["demo/17/2+3+5+6", "demo/20/1+2+3+5", "lab/12/2+3+5"])
def test_what_was_heard_from_afar_hems_nobody_in(run: str) -> None:
    """Echoes 1.5 m ahead, put on the axis of a cone, forbade to turn 3 s later: it left straight ahead, up to a wall.

    There it turned about, and its rear corner passed the wall at 32, 58 and 70 mm.
    """
    record, _, diary = run_case(parse_id(f"adaptive/judge/{run}/plain"))
    assert record["truly"], record
    assert diary.safety.closest_mm > 150, record


def until_mode(sil: Sil, mode: str) -> None:
    """Let time pass until the fault manager is in a mode, and the robot moves."""
    while sil.mode != mode or abs(sil.robot.drive.v) < 60:
        sil.step()
        assert not sil.over, f"never {mode}"


def test_a_step_that_does_not_end_breaks_s1() -> None:
    sil = Sil(Mission("lab", COURSE, faults=("off:2+3+4+5",), config={"profile": "paper"}, limit_s=60))
    safety = watch(sil)
    until_mode(sil, "STEPPING")
    assert safety.counts["S1"] == 0
    sil.robot.drive.move(900)
    sil.robot.chassis.place(5300, 3300, 180)  # no sonar has looked there
    sil.run_until(sil.now_ms / 1000 + 7)
    assert safety.counts["S1"] > 0, told(sil, safety)


def test_a_speed_that_cannot_be_braked_away_breaks_s5() -> None:
    sil = Sil(Mission("demo", COURSE, limit_s=60))
    safety = watch(sil)
    until_mode(sil, "DRIVING")
    assert safety.counts["S5"] == 0
    sil.robot.drive.v = 1500.0  # 3.75 m to stand; the wall is 2 m ahead
    sil.run_until(sil.now_ms / 1000 + 0.2)
    assert safety.counts["S5"] > 0, told(sil, safety)


@pytest.mark.parametrize(("y", "broken"), [(-600.0, True), (0.0, False)])
def test_a_turn_into_a_wall_breaks_s7(y: float, broken: bool) -> None:
    """The wall is at y = -900, and the rear corners swing 370 mm about the centre."""
    sil = Sil(Mission("demo", COURSE, limit_s=60))
    safety = watch(sil)
    sil.run_until(1.5)
    drive = sil.robot.drive
    drive.motors = True
    sil.robot.chassis.place(1800, y, 0)
    drive.head(90)
    for _ in range(40):
        sil.robot.step()
    assert (safety.counts["S7"] > 0) == broken, told(sil, safety)


def home(*steps: tuple[str, float]) -> list[str]:
    """What S4 finds wrong: a mode entered, an event, or `rest`, each with the heading then."""
    asked, wrong = Home(), []
    asked.hear("PLAN", 1, 0.0)
    asked.hear("PLAN_ROTATION", -20, 0.0)
    for word, heading in steps:
        if word == "rest":
            asked.rest(heading)
        elif word == "still":
            asked.still(heading)
        elif word in ("SWEEP", "BACKING"):
            wrong.append(asked.hear(word, 0, heading))
        elif word == "PLAN":  # another one: its first rotation is 40 degrees
            asked.hear("PLAN", 1, heading)
            asked.hear("PLAN_ROTATION", 40, heading)
        else:
            wrong.append(asked.change(word, heading))
    return [text for text in wrong if text is not None]


@pytest.mark.parametrize(
    ("steps", "broken"),
    [
        ([("SWEEPING", 5.0), ("rest", -15.0), ("rest", 5.5), ("SWEEP", 5.5)], False),
        ([("SWEEPING", 5.0), ("rest", -15.0), ("rest", 8.5), ("SWEEP", 8.5)], True),
        # The leg's bearing comes first.
        ([("SWEEPING", 5.0), ("rest", 95.0), ("rest", 75.0), ("rest", 95.0), ("SWEEP", 95.0)], False),
        ([("SWEEPING", 5.0), ("rest", 95.0), ("rest", 75.0), ("rest", 5.0), ("SWEEP", 5.0)], True),
        # One more sonar is lost in the sweep, and the new plan's first rotation is made from where it is.
        (
            [
                ("SWEEPING", 5.0),
                ("rest", -35.0),
                ("PLAN", -35.0),
                ("rest", 5.0),
                ("rest", 45.0),
                ("rest", 5.0),
                ("SWEEP", 5.0),
            ],
            False,
        ),
        (
            [
                ("SWEEPING", 5.0),
                ("rest", -35.0),
                ("PLAN", -35.0),
                ("rest", 5.0),
                ("rest", 45.0),
                ("SWEEP", 45.0),
            ],
            True,
        ),
        (
            [
                ("DRIVING", 0.0),
                ("VERIFYING", 3.0),
                ("still", 0.0),
                ("rest", 40.0),
                ("CHECKING", 0.5),
                ("DRIVING", 0.5),
            ],
            False,
        ),
        (
            [
                ("DRIVING", 0.0),
                ("VERIFYING", 3.0),
                ("still", 0.0),
                ("rest", 40.0),
                ("CHECKING", 40.0),
                ("DRIVING", 40.0),
            ],
            True,
        ),
        (
            [("VERIFYING", 0.0), ("still", 0.0), ("BACKING", 40.0), ("CHECKING", 40.0), ("DRIVING", 40.0)],
            False,
        ),
        (
            [
                ("DRIVING", 179.5),
                ("VERIFYING", 179.5),
                ("still", 179.5),
                ("CHECKING", -179.5),
                ("DRIVING", -179.5),
            ],
            False,
        ),
    ],
)
def test_s4_knows_the_heading_to_return_to(steps: list[tuple[str, float]], broken: bool) -> None:
    assert bool(home(*steps)) == broken, home(*steps)


def heard(sonar: int, range_mm: int, t_ms: float = 0.0) -> Reading:
    """A reading as the ring gives it."""
    return Reading(t_ms, sonar, range_mm, range_mm, None)


@pytest.mark.parametrize(
    ("point", "range_mm", "now_ms", "seen"),
    [
        ((900.0, 130.0), 1000, 0.0, True),
        ((900.0, 130.0), 500, 0.0, False),  # behind an echo
        ((900.0, -400.0), 1000, 0.0, False),  # beside the cone
        ((900.0, 130.0), 1000, 61_000.0, False),  # too long ago
        ((-900.0, 0.0), 1000, 0.0, False),
    ],
)
def test_ground_is_seen_in_a_cone_and_before_its_echo(
    point: tuple[float, float], range_mm: int, now_ms: float, seen: bool
) -> None:
    ground = Ground(robot_table())
    ground.hear(heard(3, range_mm), Pose(0, 0, 0), at_rest=True)
    assert ground.is_seen(np.array([point]), now_ms) == seen


def test_a_bearing_is_looked_along_from_this_place_alone() -> None:
    ground = Ground(robot_table())
    for heading in (0.0, -20.0):
        ground.hear(heard(2, 800), Pose(0, 0, heading), at_rest=True)  # mounted at 30 degrees
    assert ground.looked_along([30.0, 10.0], Pose(10, 0, 0))
    assert not ground.looked_along([-10.0], Pose(0, 0, 0))
    assert not ground.looked_along([10.0], Pose(100, 0, 0))
    ground.hear(heard(2, 800), Pose(200, 0, 0), at_rest=False)
    assert not ground.looked_along([10.0], Pose(200, 0, 0))
