# SPDX-License-Identifier: MIT
"""Rule: sub-steps (tick.c) and turns (loop.c) in C leave robot, line and fault manager bit by bit as Python does."""

from __future__ import annotations

import math
import random
from typing import Any

import pytest

from hil_sim import native
from hil_sim.errors import SimError
from hil_sim.faults.execute import FaultSet
from hil_sim.faults.grammar import parse_fault
from hil_sim.faults.kinds import SonarFault
from hil_sim.robot import robot as robot_module
from hil_sim.sil import Mission, Sighting, Sil, Trace
from hil_sim.sil.outcome import Outcome
from hil_sim.tables.robot import DEFAULT_ROBOT, robot_table
from hil_sim.world.files import load_world, world_names
from hil_sim.world.movers import Door, Mover, Person

FEW, MANY = 40, 1000
LIMIT_S = 12.0
FAULTS = (
    "off:3", "silent:4", "stuck:2@5s", "wrong:5@3s:scale=0.7", "slow:6@2s:n=5", "garbage:1", "off:front@4s",
    "intermittent:7@4s:p=0.3", "wrong:12:angle=20", "bumper:2@5s", "off:5@2s-6s", "wheel:left@3s:0.9",
    "wrong:0@2s:scale=0.5:ramp=4s", "off:4@travelled>500", "stuck:9@x>300", "link-drop:p=0.05", "link-delay:ms=40",
)  # fmt: skip
PHYSICS = ("", "", "", "rough-day", "recorded", "slip=0.1", "odometry_scale=0.02,odometry_drift_deg_m=1")


def usable(text: str, robot: str = DEFAULT_ROBOT) -> bool:
    """Whether a robot has the sonars of a fault."""
    try:
        parse_fault(text, robot_table(robot))
    except SimError:
        return False
    return True


def others(rng: random.Random, x: float, y: float) -> tuple[Mover, ...]:
    """People and doors round a start, some of whom wait for the robot."""

    def place(least_mm: float) -> tuple[float, float]:
        far, way = rng.uniform(least_mm, 2500), rng.uniform(0, 2 * math.pi)
        return x + far * math.cos(way), y + far * math.sin(way)

    made: list[Mover] = []
    for _ in range(rng.randint(1, 4)):
        near = [place(900) for _ in range(rng.randint(2, 4))]
        made.append(
            Person(
                tuple(near),
                speed=rng.choice((300.0, 800.0, 2000.0)),
                radius=rng.choice((150.0, 300.0)),
                pause=rng.choice((0.0, 1.0)),
                loop=rng.random() < 0.8,
                delay=rng.choice((0.0, 3.0)),
                yields=rng.random() < 0.7,
                patience=rng.choice((0.0, 1.0, 10.0)),
            )
        )
    if rng.random() < 0.5:
        made.append(
            Door(place(1500), closed=rng.uniform(-180, 180), open=30.0, period=6.0, yields=rng.random() < 0.7)
        )
    return tuple(made)


def mission(seed: int) -> Mission:
    """Anything that the emulator can do; most of it plain."""
    rng = random.Random(f"ticks {seed}")
    name = rng.choice(world_names())
    world = load_world(name)
    points = [(p.x_mm, p.y_mm) for p in world.goals.values()] or [(world.start.x_mm + 1000, world.start.y_mm)]
    x, y = world.start.x_mm, world.start.y_mm
    movers = others(rng, x, y) if rng.random() < 0.3 else ()
    robot = rng.choice(("p3dx-sh", "p3dx-sh", "p3at-sh", "amigo-sh", "peoplebot-sh"))
    faults = [text for text in FAULTS if usable(text, robot)]
    return Mission(
        name,
        tuple(rng.sample(points, rng.randint(1, len(points)))),
        seed=seed,
        sonar={} if rng.random() < 0.6 else {"specular": False, "crosstalk": 0.05, "margin_db": 60.0},
        limit_s=LIMIT_S,
        robot=robot,
        quirks="mobilesim" if rng.random() < 0.05 else "robot",
        physics=rng.choice(PHYSICS),
        faults=tuple(rng.sample(faults, rng.choice((0, 0, 1, 2)))),
        movers=movers,
        config={"profile": rng.choice(("argus", "paper"))},
    )


def noted(seen: list[Any]) -> Trace:
    def trace(sil: Sil, sighting: Sighting) -> None:
        seen.append(
            (sighting, sil.now_ms, sil.mode, sil.state_of_mission, len(sil.events), sil.core.status())
        )
        if len(seen) == 30 and isinstance(sil.robot.faults, FaultSet):
            sil.robot.faults.inject(fault("off:4"))

    return trace


def fault(text: str) -> SonarFault:
    made = parse_fault(text, robot_table())
    assert isinstance(made, SonarFault)
    return made


def run(one: Mission, monkeypatch: pytest.MonkeyPatch, *, in_c: bool) -> tuple[Outcome, Any, Any]:
    seen: list[Any] = []
    with monkeypatch.context() as patch:
        if not in_c:
            patch.setattr(robot_module, "ticks_of", lambda _: None)
        sil = Sil(one, trace=noted(seen) if one.seed % 3 == 1 else None)
        pieces = random.Random(one.seed)
        while one.seed % 3 == 2 and not sil.over:
            sil.run_until(sil.now_ms / 1000 + pieces.choice((0.004, 0.1, 0.37, 1.0)))
            seen.append((sil.now_ms, sil.mode, len(sil.events), sil.robot.pose, sil.server.sips))
        outcome = sil.run()
    robot, chassis = sil.robot, sil.robot.chassis
    places = [robot.pose_at(robot.now_ms - back) for back in range(0, 600, 7)]
    body = chassis.x, chassis.y, chassis.th, chassis.odo_x, chassis.odo_y, chassis.odo_th, chassis.left_mm
    speeds = robot.drive.v, robot.drive.w, robot.drive.ahead, robot.drive.turn_left, robot.stall.take()
    counts = (
        sil.server.sips,
        sil.server.unframer.counters,
        robot.anport,
        robot.last_heard_ms,
        sil.core.status(),
    )
    return outcome, (*body, *speeds, robot.state(), places, counts, robot.take_readings()), seen


def compare(seeds: range, monkeypatch: pytest.MonkeyPatch) -> None:
    assert native.library() is not None, "libargus_sim.so is not built: run tools/dev build release"
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


@pytest.mark.parametrize("seed", [682, 1017])
def test_readings_of_both_keep_their_order(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """A sub-step of Python's between some of C's, all for one SIP."""
    one = mission(seed)
    assert run(one, monkeypatch, in_c=True) == run(one, monkeypatch, in_c=False), f"seed {seed}: {one}"


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
    turns = 0

    def counted_turn(self: Sil, now_ms: float) -> None:
        nonlocal turns
        turns += 1
        turn(self, now_ms)

    turn = Sil._turn
    monkeypatch.setattr(Sil, "_turn", counted_turn)
    outcome = Sil(Mission("office", ((2300.0, 1000.0),), limit_s=30.0)).run()
    assert outcome.driven_mm > 1000
    assert steps < 30.0 * 100 / 5, f"{steps} of 3000 in Python"
    assert turns < 30.0 * 50 / 5, f"{turns} of some 1500 in Python"


def test_most_sub_steps_among_people_are_in_c(monkeypatch: pytest.MonkeyPatch) -> None:
    steps = 0

    def counted(self: Any) -> None:
        nonlocal steps
        steps += 1
        original(self)

    original = robot_module.Robot.step
    monkeypatch.setattr(robot_module.Robot, "step", counted)
    people = tuple(Person(((1500.0 + k, -1500.0), (1500.0 + k, 1500.0))) for k in range(0, 1000, 300))
    outcome = Sil(Mission("office", ((2300.0, 1000.0),), limit_s=30.0, movers=people)).run()
    assert outcome.driven_mm > 500
    assert steps < 30.0 * 100 / 4, f"{steps} of 3000 in Python"


def test_an_error_in_a_trace_comes_out() -> None:
    def trace(sil: Sil, _sighting: Sighting) -> None:
        if sil.now_ms > 3000:
            raise ZeroDivisionError

    sil = Sil(Mission("office", ((2300.0, 1000.0),), limit_s=30.0), trace=trace)
    with pytest.raises(ZeroDivisionError):
        sil.run()
    assert 3000 < sil.now_ms < 3200


def test_a_class_of_its_own_has_its_own_turns() -> None:
    class Own(Sil):
        turns = 0

        def _turn(self, now_ms: float) -> None:
            self.turns += 1
            super()._turn(now_ms)

    sil = Own(Mission("office", ((2300.0, 1000.0),), limit_s=5.0))
    sil.run()
    assert sil.turns > 100


def test_what_faults_wait_for_is_known() -> None:
    faults = FaultSet([parse_fault("off:3@2s-4s", robot_table()), parse_fault("bumper:2@5s", robot_table())])
    waits = faults.waits(0)
    assert waits is not None
    assert [(when.variable, when.value) for when in waits][:2] == [("t", 2000), ("t", 5000)]
    assert faults.afflicted == 1 << 3
