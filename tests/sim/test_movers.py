# SPDX-License-Identifier: MIT
"""Rule: people walk their way and doors swing as the file says, in time alone; they wait for a robot in their way, are
heard and bumped into like walls; and a mistake in the file is one line."""

from __future__ import annotations

import itertools
import math
from pathlib import Path

import pytest

from hil_sim.errors import SimError
from hil_sim.scenario.build import build_robot
from hil_sim.scenario.scenario import Scenario, load_scenario
from hil_sim.sonar.echo import EchoModel
from hil_sim.sonar.params import SonarParams
from hil_sim.sonar.patch import MovingEchoes
from hil_sim.tables.robot import robot_table
from hil_sim.world.body import BodyModel, body_distance
from hil_sim.world.files import load_world, load_yaml
from hil_sim.world.model import Pose
from hil_sim.world.movers import Door, Mover, Person, plain
from hil_sim.world.moving import AHEAD_MM, LEAF_MM, MovingSolids, moving_solids

AWAY = Pose(1e6, 1e6, 0.0)
HALL = load_world("hall")
START = HALL.start


BODY = robot_table().body


def track(mover: Mover, seconds: float, robot: Pose = AWAY) -> list[tuple[float, float]]:
    """Where it is after each sub-step: the person's centre, or the tip of the leaf."""
    moving = MovingSolids((mover,))
    actor, way = moving.actors[0], []
    for _ in range(round(seconds * 100)):
        moving.step(robot)
        reach = actor.reach_mm if isinstance(mover, Door) else 0.0
        way.append((actor.x + actor.c * reach, actor.y + actor.s * reach))
    return way


# ---- people -------------------------------------------------------------------------------------------------------


def test_a_person_walks_there_pauses_and_comes_back() -> None:
    way = track(Person(((0, 0), (800, 0)), speed=800, pause=2, delay=1), 8)
    at = {t: way[round(t * 100) - 1][0] for t in (0.5, 1.0, 1.5, 2.0, 3.9, 4.5, 5.0, 6.9, 7.5)}
    assert at == pytest.approx(
        {0.5: 0, 1.0: 0, 1.5: 400, 2.0: 800, 3.9: 800, 4.5: 400, 5.0: 0, 6.9: 0, 7.5: 400}, abs=25
    )


def test_a_person_follows_each_leg_at_one_speed() -> None:
    path = ((0.0, 0.0), (1000.0, 0.0), (1000.0, 30.0), (1010.0, 30.0), (1010.0, 900.0))
    way = track(Person(path, speed=1000, pause=0.5), 4)
    steps = [math.dist(a, b) for a, b in itertools.pairwise(way)]
    assert max(steps) <= 10.001
    walked = sum(math.dist(a, b) for a, b in itertools.pairwise(path))
    assert min(math.dist(p, path[-1]) for p in way) < 1
    assert sum(steps[: round(walked / 10)]) == pytest.approx(walked, abs=30)
    for x, y in way:
        assert min(abs(y), abs(x - 1000), abs(y - 30), abs(x - 1010)) < 1e-6


def test_without_loop_a_person_stays_at_the_end() -> None:
    way = track(Person(((0, 0), (500, 0)), loop=False, pause=0), 20)
    assert way[-1] == way[200] == (500, 0)


@pytest.mark.parametrize("aside", [0.0, 150.0, -300.0])
def test_a_person_stops_for_the_robot_and_after_a_while_turns_round(aside: float) -> None:
    person = Person(((-3000, 0), (3000, 0)), pause=0, patience=4)
    robot = Pose(0.0, aside, 0.0)
    way = track(person, 10, robot)
    stop = max(x for x, _ in way)
    gap = -301 - stop
    assert AHEAD_MM - 10 <= gap <= AHEAD_MM + person.radius
    assert max(x for x, _ in way[:300]) == stop
    standing = sum(abs(x - stop) < 1 for x, _ in way)
    assert 390 <= standing <= 410
    assert way[-1][0] < stop - 500
    patient = track(Person(((-3000, 0), (3000, 0)), patience=0), 60, robot)
    assert patient[-1][0] == pytest.approx(stop)
    rude = track(Person(((-3000, 0), (3000, 0)), yields=False), 7, robot)
    assert max(x for x, _ in rude) > 2000


def test_a_person_passes_a_robot_that_is_not_in_the_way() -> None:
    beside = Pose(0.0, 212.5 + 200 + 10, 0.0)
    way = track(Person(((-3000, 0), (3000, 0))), 8, beside)
    assert way[749][0] == pytest.approx(3000, abs=10)


# ---- doors --------------------------------------------------------------------------------------------------------


def test_a_door_swings_and_rests_as_its_period_says() -> None:
    way = track(Door((100, 0), width=1000, closed=90, open=0, period=10, swing=2, delay=1), 22)
    at = {t: way[round(t * 100) - 1] for t in (0.9, 2.0, 3.1, 5.9, 7.0, 8.1, 10.9, 12.0)}
    half = (100 + 1000 * math.sqrt(0.5), 1000 * math.sqrt(0.5))
    shut, wide = (100, 1000), (1100, 0)
    want = {0.9: shut, 2.0: half, 3.1: wide, 5.9: wide, 7.0: half, 8.1: shut, 10.9: shut, 12.0: half}
    for t, place in want.items():
        assert at[t] == pytest.approx(place, abs=12), t


def test_a_door_waits_while_the_robot_is_in_its_way() -> None:
    door = Door((0, 0), width=900, closed=0, open=90, period=8, swing=2)
    robot = Pose(500.0, 600.0, 0.0)
    moving = MovingSolids((door,))
    near = []
    for _ in range(3000):
        moving.step(robot)
        near.append(min(body_distance(robot, segment, BODY) for segment in moving.near(robot, 5000)))
    assert min(near) >= LEAF_MM * 0.8
    assert near[-1] < 300, "it began to open"
    assert near[-1] == near[-1000]
    rude = MovingSolids((Door((0, 0), open=90, period=8, yields=False),))
    touched = False
    for _ in range(800):
        rude.step(robot)
        touched |= BodyModel(HALL, rude).contact(robot, 0.0) is not None
    assert touched


# ---- what others make of them -------------------------------------------------------------------------------------


def test_a_person_is_heard_where_he_is() -> None:
    moving = MovingSolids((Person(((3000, 0), (1000, 0)), loop=False),))
    for in_c in (True, False):
        echoes = EchoModel(load_world("hall"), SonarParams(), in_c=in_c)
        sound = MovingEchoes(moving, SonarParams())
        x = START.x_mm
        before = echoes.range_mm(x, START.y_mm, 0.0, sound)
        assert before == pytest.approx(3000 - 200 - x, abs=8)
    for _ in range(1000):
        moving.step(AWAY)
    assert echoes.range_mm(START.x_mm, START.y_mm, 0.0, sound) == pytest.approx(800 - START.x_mm, abs=8)


def test_the_body_meets_movers_and_measures_the_way_to_them() -> None:
    moving = MovingSolids((Person(((1000, 0), (1000, 3000))),))
    body = BodyModel(HALL, moving)
    assert body.clearance_mm(Pose(0.0, 0.0, 0.0)) == pytest.approx(1000 - 200 - 210, abs=1)
    assert body.contact(Pose(589.0, 0.0, 0.0), 0.0) is None
    contact = body.contact(Pose(595.0, 0.0, 0.0), 0.0)
    assert contact is not None
    assert contact.front_segments == 0b11100, "segments 2 to 4 lie before the side that faces the robot"
    for _ in range(300):
        moving.step(AWAY)
    assert body.contact(Pose(595.0, 0.0, 0.0), 0.0) is None


def test_a_robot_stops_at_a_person_who_stands() -> None:
    scenario = Scenario("hall", people=(Person(((1500, 0), (1500, 3000)), delay=1e5),))
    robot = build_robot(scenario, HALL, Pose(0.0, 0.0, 0.0), None)
    robot.open()
    robot.enable(True)
    robot.drive.vel(400)
    for _ in range(500):
        robot.heard()
        robot.step()
    assert robot.chassis.collisions == 1
    assert robot.chassis.x == pytest.approx(1500 - 200 - 210, abs=3)


def test_no_movers_are_no_solids() -> None:
    assert moving_solids(()) is None


# ---- files --------------------------------------------------------------------------------------------------------

PEOPLE = """\
people:
  - {path: [[2000, 1000], [2000, -1000]], speed: 1200, radius: 250, pause: 1, loop: false, delay: 3}
  - {path: [[-2000, 1000], [-2000, -1000], [0, -1000]], yields: false, patience: 0, roughness: 0.5}
doors:
  - {hinge: [3000, 0], width: 800, closed: 90, open: 180, period: 12, swing: 1.5, delay: 2}
"""
MOVERS: tuple[Mover, ...] = (
    Person(((2000, 1000), (2000, -1000)), 1200, 250, 1, False, 3),
    Person(((-2000, 1000), (-2000, -1000), (0, -1000)), yields=False, patience=0, roughness=0.5),
    Door((3000, 0), 800, 90, 180, 12, 1.5, 2),
)


def test_a_world_and_a_scenario_take_them(tmp_path: Path) -> None:
    (tmp_path / "w.yaml").write_text("start: [0, 0, 0]\n" + PEOPLE)
    assert load_yaml(tmp_path / "w.yaml").movers == MOVERS
    (tmp_path / "s.yaml").write_text("world: hall\n" + PEOPLE)
    scenario = load_scenario(tmp_path / "s.yaml")
    assert scenario.movers == MOVERS
    scenario.save(tmp_path / "again.yaml")
    assert load_scenario(tmp_path / "again.yaml") == scenario
    assert plain(Person(((0, 0), (1, 1)))) == {"path": [[0, 0], [1, 1]]}
    assert plain(Door((5, 6))) == {"hinge": [5, 6]}


@pytest.mark.parametrize(
    ("line", "part"),
    [
        ("people: 3", ":2: expected a list"),
        ("people: [{speed: 3}]", ":2: 'path' is missing; add it"),
        ("people: [{path: [[0, 1000]]}]", ":2: a path needs two points or more"),
        ("people: [{path: [[0, 1000], [0, 1000]]}]", ":2: a path needs two points or more"),
        ("people: [{path: [[0, 1000], [0, a]]}]", ":2: expected a number"),
        ("people: [{path: [[0, 1000], [0, 2000]], speed: 0}]", ":2: 0 is outside 1 to 3000"),
        ("people: [{path: [[0, 1000], [0, 2000]], radius: 5000}]", ":2: 5000 is outside 50 to 1000"),
        ("people: [{path: [[0, 1000], [0, 2000]], loop: 1}]", ":2: expected true or false"),
        ("people: [{path: [[0, 1000], [0, 2000]], colour: red}]", ":2: unknown key 'colour'"),
        ("people: [{path: [[0, 0], [0, 2000]]}]", ":1: the robot would start inside a solid"),
        ("doors: [{width: 900}]", ":2: 'hinge' is missing; add it"),
        ("doors: [{hinge: [2000, 0], closed: 10, open: 10}]", ":2: open must differ from closed"),
        (
            "doors: [{hinge: [2000, 0], open: 270}]",
            ":2: open must differ from closed, by 180 degrees at most",
        ),
        ("doors: [{hinge: [2000, 0], period: 3}]", ":2: two swings take longer than the period"),
        ("doors: [{hinge: [2000, 0], period: .nan}]", ":2: expected a number"),
    ],
)
def test_a_mistake_is_one_line(tmp_path: Path, line: str, part: str) -> None:
    path = tmp_path / "w.yaml"
    path.write_text(f"start: [0, 0, 0]\n{line}\n")
    with pytest.raises(SimError) as failed:
        load_yaml(path)
    assert str(failed.value).startswith(f"{path}{part}")
