# SPDX-License-Identifier: MIT
"""Rule: the extremes of a reading are judged like any other: what stays at the least while the robot goes away from it,
or is below the least, or comes and goes faster than anything moves, is named and covered for; no reading that forbids
to turn outranks a diagnosis for ever, and what really stands there is never called a fault."""

from __future__ import annotations

from pathlib import Path

import pytest

from hil_sim.sil import Mission, Outcome, run

HALL = """about: Bare rough hall, nothing within two metres.
start: [0, 0, 0]
walls:
  - {points: [[-1500, -2000], [6000, -2000], [6000, 2000], [-1500, 2000]], closed: true}
"""
CORRIDOR = """about: Rough corridor, a wall within four metres of every sonar.
start: [0, 0, 0]
walls:
  - {points: [[-1500, -1200], [3500, -1200], [3500, 1200], [-1500, 1200]], closed: true}
"""
FOUND_S = 60.0
STUCK = [
    (0, 100),
    (1, 0),
    (2, 50),
    (3, 100),
    (3, 0),
    (4, 104),
    (5, 1),
    (6, 100),
    (7, 0),
    (8, 100),
    (12, 99),
    (15, 100),
]
NONE = [(1, 65535), (3, 5001), (6, 20000), (12, 65535)]
SPORADIC = [(0, 0), (1, 100), (3, 0), (3, 110), (5, 100), (12, 0), (15, 100)]


@pytest.fixture
def hall(tmp_path: Path) -> str:
    path = tmp_path / "hall.yaml"
    path.write_text(HALL)
    return str(path)


def drive(world: str, *faults: str, limit_s: float = 100.0) -> Outcome:
    outcome = run(Mission(world, ((4000, 0),), faults=faults, limit_s=limit_s, stop_at_goal=False))
    assert not outcome.collisions
    return outcome


def assert_covered(outcome: Outcome, sonar: int, *kinds: str, within_s: float = FOUND_S) -> None:
    out = [e for e in outcome.events if e.name == "SONAR_DISABLED"]
    assert [e.sonar for e in out] == [sonar], outcome.mission.to_json()
    assert out[0].t_s <= within_s
    assert outcome.final[sonar][0] in ("DISABLED", "PROBATION")
    assert outcome.final[sonar][1] in kinds
    # A sonar that is covered for holds nothing up: the robot gets ahead.
    assert outcome.driven_mm > 1000, outcome.mission.to_json()


@pytest.mark.tour(3, 6)
@pytest.mark.parametrize(("sonar", "value"), STUCK)
def test_what_stays_at_the_least_is_stuck(hall: str, sonar: int, value: int) -> None:
    assert_covered(drive(hall, f"stuck:{sonar}:value={value}"), sonar, "stuck")


@pytest.mark.tour(1)
@pytest.mark.parametrize(("sonar", "value"), [(3, 100), (12, 0), (6, 50)])
def test_from_mid_mission_too(hall: str, sonar: int, value: int) -> None:
    assert_covered(drive(hall, f"stuck:{sonar}@8s:value={value}"), sonar, "stuck")


@pytest.mark.tour(1)
@pytest.mark.parametrize(("sonar", "value"), NONE)
def test_what_is_beyond_the_longest_is_as_if_nothing_were_heard(hall: str, sonar: int, value: int) -> None:
    """The same comes of it as of 5000, which is what the robot gives where it hears nothing."""
    beyond, none = (drive(hall, f"stuck:{sonar}:value={v}", limit_s=160) for v in (value, 5000))
    assert beyond.final[sonar] == none.final[sonar]
    assert beyond.reached == none.reached
    assert beyond.driven_mm > 1000


@pytest.mark.tour(2, 4)
@pytest.mark.parametrize(("sonar", "value"), SPORADIC)
def test_what_leaps_to_the_least_and_back_is_intermittent(hall: str, sonar: int, value: int) -> None:
    fault = f"intermittent:{sonar}:p=0.3:value={value}"
    assert_covered(drive(hall, fault, limit_s=160), sonar, "intermittent", within_s=60)


@pytest.mark.tour(2)
@pytest.mark.parametrize(("sonar", "value"), [(0, 0), (3, 0), (4, 50), (5, 100), (12, 0)])
def test_one_reading_in_twenty_that_cannot_be_is_enough(hall: str, sonar: int, value: int) -> None:
    """Healthy sonars make none: a leap to the least weighs more than thirty good readings."""
    outcome = drive(hall, f"intermittent:{sonar}:p=0.05:value={value}", limit_s=160)
    assert_covered(outcome, sonar, "intermittent", within_s=100)


@pytest.mark.tour(2)
@pytest.mark.parametrize("seed", [1, 2, 3, 60073])
@pytest.mark.parametrize("sonar", [3, 4])
def test_what_is_covered_for_is_not_gone_round_in_tiny_steps(hall: str, sonar: int, seed: int) -> None:
    """The way is seen a little farther by each turn to it, so a stop for want of sight must end in a sweep."""
    fault = f"wrong:{sonar}:scale=0.02"
    outcome = run(Mission(hall, ((4000, 0),), faults=(fault,), seed=seed, limit_s=100))
    assert not outcome.collisions
    assert [e.sonar for e in outcome.events if e.name == "SONAR_DISABLED"] == [sonar]
    assert outcome.reached
    assert outcome.t_s < 60


@pytest.mark.parametrize("sonar", [1, 6])
@pytest.mark.parametrize(
    ("world", "goal"), [("office", (2500, 0)), ("corridor", (4000, 0)), ("open-office", (1550, 1500))]
)
def test_what_bars_both_turn_and_way_is_backed_away_from(
    world: str, goal: tuple[float, float], sonar: int
) -> None:
    """So a lie is found out. The robot used to choose a way again and again, and never to move."""
    outcome = run(Mission(world, (goal,), faults=(f"stuck:{sonar}:value=150",), seed=5, limit_s=150))
    assert [e.sonar for e in outcome.events if e.name == "SONAR_DISABLED"] == [sonar]
    assert outcome.reached
    assert not outcome.collisions


@pytest.mark.parametrize("side", [-1, 1])
def test_a_post_that_bars_both_turn_and_way_is_no_fault(tmp_path: Path, side: int) -> None:
    path = tmp_path / "post.yaml"
    # Some 180 mm from the transducer at 50 degrees, on its axis.
    path.write_text(HALL + f"boxes:\n  - {{centre: [250, {side * 270}], size: [40, 40], roughness: 1.0}}\n")
    outcome = run(Mission(str(path), ((0, side * 1500),), limit_s=100))
    assert not [e for e in outcome.events if e.name == "SONAR_DISABLED"]
    assert outcome.reached
    assert not outcome.collisions


@pytest.mark.tour(2)
@pytest.mark.parametrize("near_mm", [60, 80, 100, 120, 160])
def test_a_wall_right_ahead_is_no_fault(tmp_path: Path, near_mm: int) -> None:
    """It stands so near that it reads the least; the robot backs away from it, and the reading grows."""
    path = tmp_path / "wall.yaml"
    x = 160 + near_mm  # the foremost transducers look ahead from there, or a little behind
    path.write_text(
        "about: A wall right ahead.\nstart: [0, 0, 0]\nwalls:\n"
        f"  - {{points: [[-3000, -2000], [{x}, -2000], [{x}, 2000], [-3000, 2000]], closed: true}}\n"
    )
    outcome = run(Mission(str(path), ((-1500, 0),), limit_s=200))
    assert not [e for e in outcome.events if e.name == "SONAR_DISABLED"]
    assert outcome.reached


@pytest.mark.parametrize("side", [-1, 1])
def test_a_wall_right_beside_it_is_no_fault(tmp_path: Path, side: int) -> None:
    """Along a wall that the sonars abeam read at the least; passive, so that nobody keeps off it."""
    path = tmp_path / "side.yaml"
    y = side * 215  # 20 mm beside the body
    path.write_text(
        "about: A wall right beside.\nstart: [0, 0, 0]\nwalls:\n"
        f"  - {{points: [[-500, {y}], [6000, {y}], [6000, {-side * 2000}], [-500, {-side * 2000}]], closed: true}}\n"
    )
    outcome = run(Mission(str(path), ((4000, 0),), limit_s=60, stop_at_goal=False))
    assert not [e for e in outcome.events if e.name == "SONAR_DISABLED" and e.sonar in (0, 15, 7, 8)]


@pytest.mark.tour(1)
@pytest.mark.parametrize(("sonar", "value"), [(1, 100), (3, 0), (3, 100), (6, 50)])
def test_the_papers_method_gives_up_where_a_reading_at_the_least_forbids_to_turn(
    tmp_path: Path, sonar: int, value: int
) -> None:
    """It has no rule for extremes (docs/paper-profile.md): no verdict, and an end with its reason."""
    path = tmp_path / "corridor.yaml"
    path.write_text(CORRIDOR)
    faults = (f"stuck:{sonar}:value={value}",)
    outcome = run(Mission(str(path), ((2000, 0),), faults=faults, config={"profile": "paper"}, limit_s=200))
    told = [event.name for event in outcome.events]
    assert sonar not in [e.sonar for e in outcome.events if e.name == "SONAR_DISABLED"]
    assert "TURN_BLOCKED" in told
    assert "MISSION_FAILED" in told
    assert not outcome.reached
    assert not outcome.collisions


@pytest.mark.tour(2)
@pytest.mark.parametrize(
    ("world", "goal_mm", "fault"),
    [
        ("hall", 4000, "stuck:7:value=110"),
        ("corridor", 5000, "stuck:1:value=110"),
        ("demo", 1700, "stuck:4:value=110"),
        ("box-ahead", 2500, "stuck:12:value=100"),
        ("box-ahead", 2500, "stuck:0:value=100"),
    ],
)
def test_what_bars_the_turn_is_given_up(hall: str, world: str, goal_mm: float, fault: str) -> None:
    """No look can prove it, as the robot may not turn for it."""
    outcome = run(Mission(hall if world == "hall" else world, ((goal_mm, 0),), faults=(fault,), limit_s=100))
    assert not outcome.collisions
    assert outcome.reached, outcome.mission.to_json()
    assert {e.sonar for e in outcome.events if e.name == "SONAR_DISABLED"} == {int(fault.split(":")[1])}
