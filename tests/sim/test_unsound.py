# SPDX-License-Identifier: MIT
"""Rule: what the robot says of its own motion is checked against its wheels, the time and the ranges: a step that no
robot makes is told and left out of the pose, wheels that slip are told, and a goal is never reached by either."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from pathlib import Path

import pytest
from mutants import MutatedSil

from hil_sim.sil import Mission, Outcome, Sil, run

CORRIDOR = """about: Rough corridor.
start: [0, 0, 0]
walls:
  - {points: [[-1500, -1200], [4700, -1200], [4700, 1200], [-1500, 1200]], closed: true}
"""
GOAL_MM = 3000
NEAR_MM = 150
SEEN_MM = 60
"""What is left of the way to the goal where nothing was unseen."""
Act = Callable[[Sil], None]


@pytest.fixture
def corridor(tmp_path: Path) -> str:
    path = tmp_path / "corridor.yaml"
    path.write_text(CORRIDOR)
    return str(path)


def drive(
    world: str, act: Act, *, each: bool = False, profile: str = "argus", limit_s: float = 120.0
) -> Outcome:
    """Drive, and act on the robot when it has made half of the way; `each`: every 100 ms from then on."""
    sil = Sil(
        Mission(
            world, ((GOAL_MM, 0),), config={"profile": profile}, sonar={"crosstalk": 0.0}, limit_s=limit_s
        )
    )
    while not sil.over and sil.robot.chassis.travelled_mm < GOAL_MM / 2:
        sil.step()
    act(sil)
    k = 0
    while not sil.over:
        sil.step()
        k += 1
        if each and k % 10 == 0:
            act(sil)
    outcome = sil.outcome()
    assert not outcome.collisions
    return outcome


def names(outcome: Outcome) -> list[str]:
    return [event.name for event in outcome.events]


def odometry(x: float, y: float, deg: float) -> Act:
    def act(sil: Sil) -> None:
        chassis = sil.robot.chassis
        chassis.odo_x, chassis.odo_y, chassis.odo_th = x, y, deg

    return act


@pytest.mark.tour(4, 8)
@pytest.mark.parametrize("profile", ["argus", "paper"])
@pytest.mark.parametrize(
    "to", [(0, 0, 0), (20000, 0, 0), (-700, 300, 0), (1500, 900, 0), (2500, 0, 0), (0, 0, 90), (1500, 0, -60)]
)
def test_a_leap_is_told_and_left_out(corridor: str, to: tuple[float, float, float], profile: str) -> None:
    outcome = drive(corridor, odometry(*to), profile=profile)
    told = [n for n in names(outcome) if n in ("POSE_LEAP", "HEADING_LEAP")]
    assert told == ["HEADING_LEAP" if to == (1500, 0, -60) else "POSE_LEAP"]
    assert "GOAL_REACHED" in names(outcome)
    assert outcome.reached, outcome.goal_mm
    assert outcome.goal_mm < NEAR_MM


@pytest.mark.parametrize("silent_s", [0.4, 0.5, 0.9])
def test_a_leap_within_a_silence_in_motion_ends_the_course(corridor: str, silent_s: float) -> None:
    """Where it went in the silence no odometry tells, so a goal by its figures may be none."""
    at_s = 6.0
    fault = f"link-cut@{at_s}s-{at_s + silent_s}s"
    sil = Sil(Mission(corridor, ((GOAL_MM, 0),), faults=(fault,), sonar={"crosstalk": 0.0}, limit_s=60))
    while sil.now_ms < (at_s + silent_s) * 1000 - 50:
        sil.step()
    assert sil.robot.drive.v > 0
    odometry(0, 0, 0)(sil)
    while not sil.over:
        sil.step()
    told = names(sil.outcome())
    assert "ODOMETRY_LOST" in told
    assert "GOAL_REACHED" not in told


@pytest.mark.tour(4, 8)
@pytest.mark.parametrize(
    ("x", "y", "deg"),
    [(160, 0, 0), (-160, 0, 0), (-300, 0, 0), (0, 160, 0), (0, 0, 6), (0, 0, -12)],
)
@pytest.mark.parametrize("at_s", [5.0, 8.3])
def test_a_short_step_is_told_as_a_long_one_is(
    corridor: str, x: float, y: float, deg: float, at_s: float
) -> None:
    """Less than the robot could drive in the time, but not what its wheels say; at speed and near the goal."""
    sil = Sil(Mission(corridor, ((GOAL_MM, 0),), sonar={"crosstalk": 0.0}, limit_s=60))
    while sil.now_ms < at_s * 1000:
        sil.step()
    chassis = sil.robot.chassis
    odometry(chassis.odo_x + x, chassis.odo_y + y, chassis.odo_th + deg)(sil)
    while not sil.over:
        sil.step()
    told = names(sil.outcome())
    assert {"POSE_LEAP", "HEADING_LEAP"} & set(told), told
    assert "GOAL_REACHED" in told
    assert sil.outcome().goal_mm <= NEAR_MM


@pytest.mark.tour(2, 4)
@pytest.mark.parametrize(
    ("ahead", "aside"), [(30, 0), (50, 0), (80, 0), (-30, 0), (-50, 0), (0, 40), (0, -40), (0, 80)]
)
def test_small_leaps_of_each_second_come_to_no_false_goal(corridor: str, ahead: float, aside: float) -> None:
    """One is hardly more than the wheels make in a SIP; together they would be the way to the goal."""

    def act(sil: Sil) -> None:
        if round(sil.now_ms / 10) % 100 == 0:
            chassis = sil.robot.chassis
            c, s = math.cos(math.radians(chassis.odo_th)), math.sin(math.radians(chassis.odo_th))
            chassis.odo_x += ahead * c - aside * s
            chassis.odo_y += ahead * s + aside * c

    sil = Sil(Mission(corridor, ((GOAL_MM, 0),), sonar={"crosstalk": 0.0}, limit_s=60))
    while not sil.over:
        act(sil)
        sil.step()
    outcome = sil.outcome()
    assert "POSE_LEAP" in names(outcome)
    assert "GOAL_REACHED" not in names(outcome) or outcome.goal_mm < NEAR_MM


@pytest.mark.tour(2)
@pytest.mark.parametrize("deg", [-30, -12, 12, 20, 30, 90])
def test_a_heading_that_is_off_from_some_place_on_comes_to_no_false_goal(corridor: str, deg: float) -> None:
    """The position goes on as before: from then on the robot seems to drive aslant."""
    sil = MutatedSil(Mission(corridor, ((GOAL_MM, 0),), sonar={"crosstalk": 0.0}, limit_s=180))
    while sil.robot.chassis.travelled_mm < 800:
        sil.step()
    units = round(deg * 4096 / 360)
    sil.lying.alter = lambda packet: dataclasses.replace(packet, th=(packet.th + units) % 4096)
    while not sil.over:
        sil.step()
    outcome = sil.outcome()
    assert "HEADING_LEAP" in names(outcome)
    assert "GOAL_REACHED" not in names(outcome) or outcome.goal_mm < NEAR_MM


@pytest.mark.parametrize(
    ("battery", "x10", "odd"),
    [(0, 0, True), (255, 255, False), (127, 65535, True), (127, 400, True), (127, 30, True), (127, 0, False)],
)
def test_a_voltage_that_no_battery_has_is_told_once(corridor: str, battery: int, x10: int, odd: bool) -> None:
    sil = MutatedSil(Mission(corridor, ((GOAL_MM, 0),), sonar={"crosstalk": 0.0}, limit_s=60))
    sil.lying.alter = lambda packet: dataclasses.replace(packet, battery=battery, battery_x10=x10)
    while not sil.over:
        sil.step()
    told = names(sil.outcome())
    assert [e.value for e in sil.outcome().events if e.name == "BATTERY_ODD"] == [x10 or battery] * odd
    assert "BATTERY_LOW" not in told
    assert "GOAL_REACHED" in told


def test_what_leaps_all_the_time_ends_the_course(corridor: str) -> None:
    k = 0

    def act(sil: Sil) -> None:
        nonlocal k
        k += 1
        sil.robot.chassis.odo_x = 20000.0 if k % 2 else 0.0

    outcome = drive(corridor, act, each=True)
    assert names(outcome).count("POSE_LEAP") == 2
    assert names(outcome).count("ODOMETRY_LOST") == 1
    assert "MISSION_FAILED" in names(outcome)
    assert "GOAL_REACHED" not in names(outcome)


@pytest.mark.parametrize("deg", [30, -90, 180])
def test_a_heading_that_leaps_all_the_time_ends_the_course(corridor: str, deg: float) -> None:
    def act(sil: Sil) -> None:
        sil.robot.chassis.odo_th += deg

    outcome = drive(corridor, act, each=True)
    assert names(outcome).count("HEADING_LEAP") == 2
    assert "ODOMETRY_LOST" in names(outcome)
    assert "GOAL_REACHED" not in names(outcome)


def lifted(
    world: str,
    at: tuple[float, float],
    *,
    by: tuple[float, float] = (GOAL_MM, 0),
    profile: str = "argus",
    seed: int = 1,
    free_s: float = 0.0,
    turns: bool = True,
) -> Outcome:
    """From then on the wheels turn and the body stays: it pushes against a sill, or is jacked up and does not turn."""
    start = (at[0], at[1], 0.0)
    goal = (at[0] + by[0], at[1] + by[1])
    mission = Mission(world, (goal,), start, config={"profile": profile}, seed=seed, limit_s=120)
    sil = Sil(mission)
    sil.run_until(free_s)
    x, y, heading = sil.robot.chassis.x, sil.robot.chassis.y, sil.robot.chassis.th
    while not sil.over:
        sil.step()
        chassis = sil.robot.chassis
        chassis.place(x, y, chassis.th if turns else heading)
    return sil.outcome()


def rough_corridor(folder: Path, half_mm: int) -> str:
    """Its ends are out of sight, and rough walls are heard at the edges of the cones, as far off all the way."""
    path = folder / "corridor.yaml"
    path.write_text(
        "about: A corridor whose ends no sonar hears.\nstart: [0, 0, 0]\nroughness: 1.0\nwalls:\n"
        f"  - {{points: [[-7000, {-half_mm}], [14000, {-half_mm}], [14000, {half_mm}], [-7000, {half_mm}]],\n"
        "     closed: true}\n"
    )
    return str(path)


@pytest.mark.tour(4, 8)
@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("half_mm", [600, 700, 800, 900, 1100])
def test_a_long_rough_corridor_is_no_slip(tmp_path: Path, half_mm: int, seed: int) -> None:
    outcome = run(Mission(rough_corridor(tmp_path, half_mm), ((6000, 0),), seed=seed, limit_s=90))
    assert "SLIP" not in names(outcome)
    assert outcome.reached


@pytest.mark.tour(2)
def test_a_corridor_hardly_wider_than_the_swing_is_no_slip(tmp_path: Path) -> None:
    """One echo that is not there closes it: then the robot turns about and may run out of time."""
    world = rough_corridor(tmp_path, 550)
    outcomes = [run(Mission(world, ((6000, 0),), seed=seed, limit_s=90)) for seed in range(1, 9)]
    assert all("SLIP" not in names(outcome) for outcome in outcomes)
    assert sum(outcome.reached for outcome in outcomes) >= 6


def behind_the_cable(
    world: str, at_s: float, unseen_s: float, gone_s: float, *, restarts: bool
) -> MutatedSil:
    """The cable is out for a while in which the robot drives on by itself, and perhaps restarts."""
    sil = MutatedSil(Mission(world, ((GOAL_MM, 0),), sonar={"crosstalk": 0.0}, limit_s=60))
    sil.wait(at_s)
    sil.lose()
    sil.wait(unseen_s)
    if restarts:
        sil.power_cycle()
    sil.wait(gone_s)
    sil.plug()
    sil.wait(math.inf)
    assert not sil.robot.hits
    return sil


@pytest.mark.parametrize(
    ("at_s", "unseen_s", "gone_s"),
    [(4.0, 0.0, 0.1), (5.0, 0.4, 0.3), (6.0, 1.5, 0.02), (7.0, 0.8, 3.0), (8.0, 1.8, 1.0)],
)
def test_one_that_restarts_in_motion_unseen_ends_the_course(
    corridor: str, at_s: float, unseen_s: float, gone_s: float
) -> None:
    told = [e.name for e in behind_the_cable(corridor, at_s, unseen_s, gone_s, restarts=True).events]
    assert told.count("ODOMETRY_LOST") == 1
    assert "MISSION_FAILED" in told
    assert "GOAL_REACHED" not in told


@pytest.mark.parametrize(
    ("at_s", "gone_s"), [(4.0, 0.02), (5.0, 0.3), (6.0, 0.6), (7.0, 1.2), (8.0, 2.0), (6.5, 5.0)]
)
def test_one_that_only_drove_on_unseen_knows_where_it_is(corridor: str, at_s: float, gone_s: float) -> None:
    sil = behind_the_cable(corridor, at_s, 0.0, gone_s, restarts=False)
    assert "GOAL_REACHED" in [e.name for e in sil.events]
    assert sil.outcome().goal_mm < SEEN_MM


@pytest.mark.parametrize("aside_mm", [0, 150, 350])
@pytest.mark.parametrize(("at_s", "later_s", "gone_s"), [(4.0, 0.1, 5.0), (5.0, 0.05, 5.0), (5.0, 0.8, 3.0)])
def test_counters_that_restart_in_a_long_silence_end_the_course(
    corridor: str, aside_mm: float, at_s: float, later_s: float, gone_s: float
) -> None:
    """Its session goes on, and what it drove since looks like a step that it may have made since the last SIP."""
    fault = f"link-cut@{at_s}s-{at_s + gone_s}s"
    sil = MutatedSil(
        Mission(corridor, ((GOAL_MM, aside_mm),), faults=(fault,), sonar={"crosstalk": 0.0}, limit_s=60)
    )
    sil.wait(at_s + later_s)
    assert sil.robot.drive.v > 0
    odometry(0, 0, 0)(sil)
    sil.wait(math.inf)
    told = [e.name for e in sil.events]
    assert told.count("ODOMETRY_LOST") == 1
    assert "MISSION_FAILED" in told
    assert "GOAL_REACHED" not in told


@pytest.mark.tour(4, 8)
@pytest.mark.parametrize("at_s", [2.5, 3.0, 3.5, 4.0, 5.0])
@pytest.mark.parametrize("gone_s", [0.7, 1.5, 5.0])
def test_a_long_silence_alone_does_not(corridor: str, at_s: float, gone_s: float) -> None:
    """Near where it began to count, too: order, watchdog and brakes say how far it goes on."""
    fault = f"link-cut@{at_s}s-{at_s + gone_s}s"
    sil = Sil(Mission(corridor, ((GOAL_MM, 0),), faults=(fault,), sonar={"crosstalk": 0.0}, limit_s=60))
    told = names(sil.run())
    assert "ODOMETRY_LOST" not in told
    assert "GOAL_REACHED" in told
    assert sil.outcome().goal_mm < SEEN_MM


HOME: tuple[tuple[float, float], ...] = ((1200, 0), (60, 0), (60, 700))
"""It comes back to the place where its counters began, and turns there."""


def comes_home(sil: MutatedSil) -> bool:
    pose = sil.robot.chassis
    return abs(pose.th) > 150 and pose.x < 500 and sil.robot.drive.v > 100


def turns_at_home(sil: MutatedSil) -> bool:
    home = any(e.name == "WAYPOINT" and e.value == 2 for e in sil.events)
    return home and abs(sil.robot.drive.w) > 30


def run_until(world: str, there: Callable[[MutatedSil], bool], cut: tuple[str, ...] = ()) -> MutatedSil:
    sil = MutatedSil(Mission(world, HOME, faults=cut, sonar={"crosstalk": 0.0}, limit_s=90))
    while not there(sil):
        assert not sil.over
        sil.wait(0.1)
    return sil


@pytest.mark.parametrize("later_s", [0.0, 0.3, 0.6])
@pytest.mark.parametrize("gone_s", [0.7, 1.0, 2.5])
@pytest.mark.parametrize("there", [comes_home, turns_at_home])
def test_a_silence_near_zero_on_another_heading_ends_no_course(
    corridor: str, there: Callable[[MutatedSil], bool], later_s: float, gone_s: float
) -> None:
    at_s = run_until(corridor, there).now_ms / 1000 + later_s
    sil = run_until(corridor, there, (f"link-cut@{at_s}s-{at_s + gone_s}s",))
    sil.wait(math.inf)
    told = [e.name for e in sil.events]
    assert "LINK_STALLED" in told
    assert "ODOMETRY_LOST" not in told
    assert "GOAL_REACHED" in told
    assert sil.outcome().goal_mm < SEEN_MM


@pytest.mark.parametrize("later_s", [0.0, 0.3, 0.6])
@pytest.mark.parametrize("there", [comes_home, turns_at_home])
def test_counters_that_restart_near_zero_on_another_heading_end_it(
    corridor: str, there: Callable[[MutatedSil], bool], later_s: float
) -> None:
    at_s = run_until(corridor, there).now_ms / 1000 + later_s
    sil = run_until(corridor, there, (f"link-cut@{at_s}s-{at_s + 1.0}s",))
    sil.wait(later_s + 0.3)
    odometry(0, 0, 0)(sil)
    sil.wait(math.inf)
    told = [e.name for e in sil.events]
    assert "ODOMETRY_LOST" in told
    assert "GOAL_REACHED" not in told


def test_one_that_restarts_at_rest_keeps_its_course(corridor: str) -> None:
    sil = MutatedSil(Mission(corridor, ((GOAL_MM, 0),), sonar={"crosstalk": 0.0}, limit_s=90))
    sil.wait(5.0)
    sil.lose()
    sil.wait(5.0)  # its watchdog has stopped it
    sil.plug()
    while not any(e.name == "SESSION_DISLODGED" for e in sil.events):
        sil.wait(0.02)  # then its old session has told where it rests
    sil.lose()
    sil.power_cycle()
    sil.plug()
    sil.wait(math.inf)
    assert "ODOMETRY_LOST" not in [e.name for e in sil.events]
    assert "GOAL_REACHED" in [e.name for e in sil.events]
    assert sil.outcome().goal_mm < SEEN_MM


BOX = """about: A robot between a box ahead and a wall behind.
start: [0, 0, 0]
walls:
  - {points: [[-1300, -1500], [2300, -1500], [2300, 1500], [-1300, 1500]], closed: true}
"""


@pytest.mark.parametrize(
    ("profile", "at"), [("argus", (0, 0)), ("argus", (-200, 300)), ("argus", (300, -200))]
)
def test_lifted_wheels_are_told_and_end_the_course(
    tmp_path: Path, profile: str, at: tuple[float, float]
) -> None:
    path = tmp_path / "box.yaml"
    path.write_text(BOX)
    outcome = lifted(str(path), at, profile=profile)
    assert names(outcome).count("SLIP") >= 2, names(outcome)
    assert "ODOMETRY_LOST" in names(outcome)
    assert "GOAL_REACHED" not in names(outcome)
    assert "MISSION_FAILED" in names(outcome)


@pytest.mark.tour(3, 6)
@pytest.mark.parametrize("seed", range(1, 4))
@pytest.mark.parametrize("world", ["office", "box-ahead", "lab", "demo"])
def test_lifted_wheels_are_told_in_the_worlds_that_are_there(world: str, seed: int) -> None:
    """Where something within 2.5 m of the way ahead or behind can tell; in a hall nothing can."""
    outcome = lifted(world, (0, 0), seed=seed)
    assert "SLIP" in names(outcome)
    assert "GOAL_REACHED" not in names(outcome)


@pytest.mark.tour(3, 6)
@pytest.mark.parametrize("by", [(GOAL_MM, 0), (1700, 1550)])
@pytest.mark.parametrize("seed", range(1, 4))
@pytest.mark.parametrize("world", ["lab", "demo"])
def test_a_robot_on_a_stand_reaches_no_goal_behind_a_turn(
    world: str, seed: int, by: tuple[float, float]
) -> None:
    """Its ring hears in each turn what it heard before; nor is a sonar given up for that."""
    outcome = lifted(world, (0, 0), by=by, seed=seed, turns=False)
    assert not {"GOAL_REACHED", "SONAR_DISABLED"} & set(names(outcome)), names(outcome)


@pytest.mark.parametrize("seed", range(1, 4))
def test_wheels_lifted_on_the_way_reach_no_goal(seed: int) -> None:
    """What is left of the way is too short for the whole proof."""
    outcome = lifted("lab", (0, 0), seed=seed, free_s=6.0)
    assert "SLIP" in names(outcome)
    assert "GOAL_REACHED" not in names(outcome)


@pytest.mark.parametrize("seed", range(1, 6))
def test_rough_days_slip_a_little_and_nobody_calls_it_lost(corridor: str, seed: int) -> None:
    outcome = Sil(Mission(corridor, ((GOAL_MM, 0),), seed=seed, physics="rough-day", limit_s=150)).run()
    assert not {"POSE_LEAP", "HEADING_LEAP", "ODOMETRY_LOST", "SLIP"} & set(names(outcome))
    assert math.isfinite(outcome.goal_mm)
