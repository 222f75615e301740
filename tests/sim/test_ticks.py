# SPDX-License-Identifier: MIT
"""Rule: sub-steps in C (tick.c) leave robot, line and fault manager bit by bit as those in Python do."""

from __future__ import annotations

import random
from typing import Any

import pytest

from hil_sim.faults.execute import FaultSet
from hil_sim.faults.grammar import parse_fault
from hil_sim.robot import robot as robot_module
from hil_sim.sil import Mission, Sil
from hil_sim.sil.outcome import Outcome
from hil_sim.sonar import kernel
from hil_sim.tables.robot import robot_table
from hil_sim.world.files import load_world, world_names
from hil_sim.world.movers import Person

FEW, MANY = 40, 1000
LIMIT_S = 12.0
FAULTS = (
    "off:3", "silent:4", "stuck:2@5s", "wrong:5@3s:scale=0.7", "slow:6@2s:n=5", "garbage:1", "off:front@4s",
    "intermittent:7@4s:p=0.3", "wrong:12:angle=20", "bumper:2@5s", "off:5@2s-6s", "wheel:left@3s:0.9",
    "wrong:0@2s:scale=0.5:ramp=4s", "off:4@travelled>500", "stuck:9@x>300", "link-drop:p=0.05", "link-delay:ms=40",
)  # fmt: skip
PHYSICS = ("", "", "", "rough-day", "recorded", "slip=0.1", "odometry_scale=0.02,odometry_drift_deg_m=1")


def usable(text: str) -> bool:
    try:
        parse_fault(text, robot_table())
    except Exception:
        return False
    return True


def mission(seed: int) -> Mission:
    """Anything that the emulator can do; most of it plain."""
    rng = random.Random(f"ticks {seed}")
    name = rng.choice(world_names())
    world = load_world(name)
    points = [(p.x_mm, p.y_mm) for p in world.goals.values()] or [(world.start.x_mm + 1000, world.start.y_mm)]
    x, y = world.start.x_mm, world.start.y_mm
    people = (Person(((x + 1500.0, y - 300.0), (x + 1500.0, y + 900.0))),) if rng.random() < 0.1 else ()
    return Mission(
        name,
        tuple(rng.sample(points, rng.randint(1, len(points)))),
        seed=seed,
        sonar={} if rng.random() < 0.6 else {"specular": False, "crosstalk": 0.05, "margin_db": 60.0},
        limit_s=LIMIT_S,
        robot=rng.choice(("p3dx-sh", "p3dx-sh", "p3at-sh", "amigo-sh", "peoplebot-sh")),
        quirks="mobilesim" if rng.random() < 0.05 else "robot",
        physics=rng.choice(PHYSICS),
        faults=tuple(rng.sample(FAULTS, rng.choice((0, 0, 1, 2)))),
        movers=people,
        config={"profile": rng.choice(("argus", "paper"))},
    )


def run(one: Mission, monkeypatch: pytest.MonkeyPatch, *, in_c: bool) -> tuple[Outcome, Any, Any]:
    with monkeypatch.context() as patch:
        if not in_c:
            patch.setattr(robot_module, "ticks_of", lambda _: None)
        sil = Sil(one)
        outcome = sil.run()
    robot, chassis = sil.robot, sil.robot.chassis
    places = [robot.pose_at(robot.now_ms - back) for back in range(0, 600, 7)]
    body = chassis.x, chassis.y, chassis.th, chassis.odo_x, chassis.odo_y, chassis.odo_th, chassis.left_mm
    speeds = robot.drive.v, robot.drive.w, robot.drive.ahead, robot.drive.turn_left, robot.stall.take()
    return outcome, (*body, *speeds, robot.state(), places), robot.take_readings()


def compare(seeds: range, monkeypatch: pytest.MonkeyPatch) -> None:
    assert kernel.library() is not None, "libargus_sim.so is not built: run tools/dev build release"
    drove = 0
    for seed in seeds:
        one = mission(seed)
        in_c, in_python = run(one, monkeypatch, in_c=True), run(one, monkeypatch, in_c=False)
        assert in_c[0] == in_python[0], f"seed {seed}: {one}"
        assert in_c[1:] == in_python[1:], f"seed {seed}: {one}"
        drove += in_c[0].driven_mm > 200
    assert drove > len(seeds) / 4, "the robots drive"


def test_missions_are_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    compare(range(FEW), monkeypatch)


@pytest.mark.soak
def test_many_missions_are_alike(monkeypatch: pytest.MonkeyPatch) -> None:
    compare(range(FEW, FEW + MANY), monkeypatch)


def test_every_fault_of_the_list_is_one() -> None:
    assert all(usable(text) for text in FAULTS), [text for text in FAULTS if not usable(text)]


def test_most_sub_steps_of_a_plain_drive_are_in_c(monkeypatch: pytest.MonkeyPatch) -> None:
    """Else the rule above compares Python with Python."""
    steps = 0

    def counted(self: Any) -> None:
        nonlocal steps
        steps += 1
        original(self)

    original = robot_module.Robot.step
    monkeypatch.setattr(robot_module.Robot, "step", counted)
    sil = Sil(Mission("office", ((2300.0, 1000.0),), limit_s=30.0))
    outcome = sil.run()
    assert outcome.driven_mm > 1000
    assert steps < 30.0 * 100 / 5, f"{steps} of 3000 in Python"


def test_what_faults_wait_for_is_known() -> None:
    faults = FaultSet([parse_fault("off:3@2s-4s", robot_table()), parse_fault("bumper:2@5s", robot_table())])
    waits = faults.waits(0)
    assert waits is not None
    assert [(when.variable, when.value) for when in waits][:2] == [("t", 2000), ("t", 5000)]
    assert faults.afflicted == 1 << 3
