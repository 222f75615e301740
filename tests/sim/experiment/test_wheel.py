# SPDX-License-Identifier: MIT
"""Rule: a wheel that turns less than it is told is named with its side and size and countered; no healthy one is."""

from __future__ import annotations

from pathlib import Path

import pytest
import yaml

from hil_sim.errors import SimError
from hil_sim.experiment import wheel
from hil_sim.faults.grammar import parse_fault
from hil_sim.faults.kinds import WheelFault
from hil_sim.sil import Mission, Outcome, Sil
from hil_sim.sil import run as run_mission


def told(outcome: Outcome) -> list[tuple[float, str, int]]:
    """What was said of wheels."""
    return [(event.t_s, event.name, event.value) for event in outcome.events if "WHEEL" in event.name]


@pytest.mark.soak
def test_the_error_at_5_m_is_cut_to_a_fifth() -> None:
    rows = wheel.run()
    assert len(rows) == 6
    for row in rows:
        assert row.named is not None, row
        assert row.named == pytest.approx(row.true_pm, abs=max(2.0, 0.1 * abs(row.true_pm))), row
        assert row.named_at_mm is not None, row
        assert row.named_at_mm < 1500, row
        assert row.countered_end_mm < row.alone_mm / 5, row
        assert row.countered_mm < row.alone_mm / 5, row


@pytest.fixture
def hall(tmp_path: Path) -> str:
    path = tmp_path / "hall.yaml"
    path.write_text(yaml.safe_dump(dict(wheel.HALL)), encoding="utf-8")
    return str(path)


def test_a_wheel_that_is_mended_is_cleared(hall: str) -> None:
    course = ((5000.0, 0.0), (0.0, 0.0)) * 3
    outcome = run_mission(Mission(hall, course, faults=("wheel:left@0s-12s:0.95",), limit_s=120))
    names = [name for _, name, _ in told(outcome)]
    assert names == ["WHEEL_SHORT", "WHEEL_EVEN"], told(outcome)
    assert "GOAL_REACHED" in [event.name for event in outcome.events]


def test_with_the_rear_ahead_it_is_the_same_wheel() -> None:
    # Where walls are heard abeam: in the open nothing contradicts an array that hears nothing.
    faults = ("off:front", "wheel:right@8s:0.93")
    outcome = run_mission(Mission("corridor", ((5500.0, 0.0), (0.0, 0.0)), faults=faults, limit_s=120))
    assert [event.value for event in outcome.events if event.name == "REVERSED"] == [1]
    assert told(outcome), "never named"
    assert -85 < told(outcome)[0][2] < -55, told(outcome)


@pytest.mark.tour(2)
@pytest.mark.parametrize("profile", ["argus", "paper"])
@pytest.mark.parametrize(
    ("world", "physics", "quirks"),
    [
        ("lab", "rough-day", "robot"),
        ("office", "rough-day,slip=0.1", "robot"),
        ("corridor", "rough-day", "robot"),
        ("lab", "rough-day", "mobilesim"),
    ],
)
def test_no_healthy_wheel_is_named(world: str, physics: str, quirks: str, profile: str) -> None:
    course = {
        "lab": ((1700.0, 0.0), (1700.0, 1900.0), (0.0, 2100.0)),
        "office": ((2300.0, 1000.0), (0.0, 0.0)),
        "corridor": ((7000.0, 0.0),),
    }[world]
    for seed in (1, 2):
        mission = Mission(
            world, course, seed=seed, physics=physics, quirks=quirks, config={"profile": profile}, limit_s=60
        )
        outcome = run_mission(mission)
        assert told(outcome) == [], mission.to_json()


def test_sonar_faults_name_no_wheel() -> None:
    """Weaving and sweeps turn the robot all the time."""
    mission = Mission("lab", ((1700.0, 0.0), (1700.0, 1900.0)), faults=("off:3+4",), limit_s=90)
    assert told(run_mission(mission)) == []


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("wheel:0.95", "which wheel"),
        ("wheel:rear:0.95", "which wheel"),
        ("wheel:left", "part that is left"),
        ("wheel:left:1.1", "part that is left"),
        ("wheel:left:0.4", "part that is left"),
        ("wheel:left:p=0.9", "part that is left"),
        ("wheel:left@9s-3s:0.9", "ends before it begins"),
    ],
)
def test_no_fault_of_a_wheel(text: str, said: str) -> None:
    with pytest.raises(SimError, match=said):
        parse_fault(text)


def test_a_fault_of_a_wheel_is_read() -> None:
    fault = parse_fault("wheel:right@10s-20s:0.9")
    assert isinstance(fault, WheelFault)
    assert (fault.side, fault.part) == ("right", 0.9)
    assert fault.start is not None
    assert fault.start.value == 10_000


def test_encoders_see_it_and_a_heading_is_still_come_to(hall: str) -> None:
    """A MOVE bends to the side of the short wheel, in truth as in odometry; HEAD ends where it was asked to."""
    sil = Sil(Mission(hall, (), faults=("wheel:left@3s-40s:0.9",), config={"active": "off"}, limit_s=100))
    sil.run_until(2.0)
    robot, chassis = sil.robot, sil.robot.chassis
    robot.enable(True)
    robot.drive.set_speed(200)
    robot.drive.move(150)
    sil.run_until(3.0)
    assert abs(chassis.odo_th) < 0.01, "bends before it begins"
    robot.drive.move(1000)
    sil.run_until(12.0)
    # 1 m by the mean of both wheels, 105 mm apart, over the track
    bent = 1000 * 0.1 / 0.95 / robot.table.motion["track_mm"] * 57.2958
    assert chassis.odo_th == pytest.approx(bent, rel=0.03)
    assert chassis.th == pytest.approx(chassis.odo_th, abs=0.7)
    robot.drive.head(90)
    sil.run_until(20.0)
    assert chassis.odo_th == pytest.approx(90, abs=0.5)
    left, right = robot.drive.wheel_speeds()
    assert left == right == 0
    sil.run_until(41.0)
    before = chassis.odo_th
    robot.drive.move(500)
    sil.run_until(47.0)
    assert chassis.odo_th == pytest.approx(before, abs=0.01), "bends after its end"
