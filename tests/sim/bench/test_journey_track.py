# SPDX-License-Identifier: MIT
"""Rule: what a record says of a journey is what the robot did, by its true pose and by the clock."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import pytest
from bench.journeys import DEADLY, deadly
from bench.missions import outcome

from hil_sim.bench.journey import mission_of, parse_id
from hil_sim.bench.journey_track import (
    FREE,
    LOOKING,
    Diary,
    People,
    failed,
    head,
    is_seen,
    run_case,
    take_people,
    work,
)
from hil_sim.bench.pool import run_here
from hil_sim.sil import Collision, Sighting, Sightings, Sil, run
from hil_sim.tables.robot import robot_table
from hil_sim.world.body import BodyModel
from hil_sim.world.files import load_world
from hil_sim.world.model import Floats, Pose

CASE = "argus/tune/doors+one+start/doors-1/2"


@dataclass
class Watch:
    """Notes everything the slow way."""

    at: list[tuple[float, float]] = field(default_factory=list)
    near: list[float] = field(default_factory=list)
    looking: list[bool] = field(default_factory=list)
    speeds: list[float] = field(default_factory=list)
    headings: list[float] = field(default_factory=list)
    body: BodyModel | None = None

    def __call__(self, sil: Sil, sighting: Sighting) -> None:
        if self.body is None:
            self.body = BodyModel(sil.world, None, robot_table().body)
        self.at.append((sil.robot.chassis.x, sil.robot.chassis.y))
        self.looking.append(sil.mode == LOOKING)
        self.speeds.append(abs(sil.robot.drive.v))
        self.headings.append(sil.robot.chassis.th)
        if sil.mode == FREE and sil.robot.drive.v > 5:
            self.near.append(self.body.clearance_mm(sil.robot.chassis.pose))


@pytest.fixture(scope="module")
def both() -> tuple[dict[str, object], Watch]:
    watch = Watch()
    same = run(mission_of(parse_id(CASE)), trace=watch)
    record = run_case(parse_id(CASE))[0]
    assert record["digest"] == same.digest
    return record, watch


def test_the_closest_is_the_smallest_of_all(both: tuple[dict[str, object], Watch]) -> None:
    record, watch = both
    assert record["closest_mm"] == round(min(watch.near), 1)


def test_turns_and_looks_are_counted(both: tuple[dict[str, object], Watch]) -> None:
    record, watch = both
    turned = sum(abs(b - a) for a, b in zip(watch.headings, watch.headings[1:], strict=False))
    assert record["turned_deg"] == pytest.approx(turned, abs=0.1)
    begun = sum(
        now and not before for before, now in zip([False, *watch.looking], watch.looking, strict=False)
    )
    assert record["looks"] == begun


def test_modes_make_up_the_clock(both: tuple[dict[str, object], Watch]) -> None:
    record, _ = both
    modes, t_s = record["modes_s"], record["t_s"]
    assert isinstance(modes, dict)
    assert isinstance(t_s, float)
    assert abs(sum(modes.values()) - t_s) < 1.0
    looking = record["looking_s"]
    assert isinstance(looking, float)
    assert abs(modes.get(LOOKING, 0.0) - looking) < 0.2 * (1 + len(record["looks_at"]))  # type: ignore[arg-type]


def test_the_path_is_the_way(both: tuple[dict[str, object], Watch]) -> None:
    record, watch = both
    path = record["path"]
    assert isinstance(path, list)
    assert max(min(math.dist(spot, there) for there in path) for spot in watch.at) < 201
    assert math.dist(path[0], watch.at[0]) < 1
    assert all(spot in path for spot in [*record["stops_at"], *record["looks_at"]])  # type: ignore[misc]


def test_a_stop_is_one_of_a_robot_that_ran(both: tuple[dict[str, object], Watch]) -> None:
    record, watch = both
    stops, runs = 0, False
    for speed in watch.speeds:
        stops += runs and speed <= 5
        runs = speed > 50 or (runs and speed > 5)
    assert stops > 0
    assert record["stops"] == stops


def test_a_robot_that_does_not_move_makes_no_way() -> None:
    mission = mission_of(parse_id(CASE))
    sightings = Sightings()
    sil = Sil(type(mission)(mission.world, (), limit_s=5.0, stop_at_goal=False), sightings=sightings)
    sil.run()
    fields = Diary.of(sightings.seen.rows, sil.world, robot_table().body).fields()
    assert (fields["stops"], fields["turned_deg"], fields["closest_mm"], fields["early_mm"]) == (
        0,
        0,
        None,
        0,
    )
    assert len(fields["path"]) == 1


def test_without_a_sip_there_is_nothing() -> None:
    fields = Diary.of(Sightings().seen.rows, load_world("lab"), robot_table().body).fields()
    assert (fields["path"], fields["modes_s"], fields["closest_mm"]) == ([], {}, None)


def test_there_by_its_word_but_not_truly() -> None:
    record = run_case(parse_id("ideal/tune/rooms/lab/1"))[0]
    assert record["word"] == "reached"
    assert record["progress_mm"] == record["course_mm"]
    assert record["truly"] == (record["goal_mm"] <= 150)
    # It thinks that it is within 60 mm of its goal: the rest is its odometry.
    assert abs(record["goal_mm"] - record["odometry_off_mm"]) <= 61


def test_work_never_raises() -> None:
    record = work("argus/tune/rooms/mars/1")
    assert "mars" in record["error"]
    assert record["id"] == head(parse_id("argus/tune/rooms/mars/1"))["id"]


def test_a_process_that_dies_costs_its_own_journey_only() -> None:
    names = [f"argus/tune/rooms/lab/{seed}" for seed in range(1, 6)]
    records = {record["id"]: record for record in run_here(names, 2, deadly, failed)}
    assert set(records) == set(names)
    assert [name for name in names if records[name]["error"]] == [DEADLY]
    assert records[DEADLY]["ideal"] == "ideal/tune/rooms/lab/2"


def test_people_are_no_collision_with_a_wall() -> None:
    wall, person = Collision(3.0, -1700.0, 0.0, False), Collision(4.0, 100.0, 100.0, False)
    struck = Collision(5.0, 100.0, 100.0, True)
    result = outcome(hits=[wall, person, struck])
    assert take_people(result, load_world("lab")) == [person]
    assert result.collisions == [wall, struck]


WALLS = np.array([[5000.0, -3000.0, 5000.0, 3000.0]])
"""Hides nobody of these."""


def approach(
    robot: list[tuple[float, float]], person: list[tuple[float, float]], walls: Floats = WALLS
) -> bool:
    """Whether the contact at the end of both ways, in steps of 0.1 s, is one that was met ahead."""
    people = People()
    for k, (at, who) in enumerate(zip(robot, person, strict=True)):
        people.note(k / 10, Pose(*at, 0.0), [who], walls)
    x, y = robot[-1]
    return people.is_met_ahead(Collision(len(robot) / 10, x, y, False), 0.0)


def test_who_stands_before_the_robot_is_met_ahead() -> None:
    way = [(-1500.0 + 30 * k, 0.0) for k in range(40)]
    assert approach(way, [(200.0, 0.0)] * 40)


def test_who_is_seen_coming_for_a_second_is_met_ahead() -> None:
    way = [(-600.0 + 20 * k, 0.0) for k in range(20)]
    comes = [(2000.0 - 80 * k, 0.0) for k in range(20)]
    assert approach(way, comes)


def test_who_comes_from_the_side_or_from_behind_walked_in() -> None:
    way = [(20.0 * k, 0.0) for k in range(30)]
    aside = [(580.0, -1800.0 + 50 * k) for k in range(30)]
    assert not approach(way, aside)
    behind = [(-2500.0 + 90 * k, 0.0) for k in range(30)]
    assert not approach(way, behind)


def test_who_steps_out_of_a_door_just_before_the_robot_walked_in() -> None:
    wall = np.array([[-5000.0, -350.0, 5000.0, -350.0]])
    way = [(20.0 * k, 0.0) for k in range(30)]
    steps_out = [(2600.0 - 55 * k, -1200.0 + 37 * k) for k in range(30)]
    assert not approach(way, steps_out, wall)
    assert approach(way, steps_out, WALLS), "without the wall he is seen for longer"


def test_a_person_beyond_a_wall_or_aside_is_not_seen() -> None:
    robot = Pose(0.0, 0.0, 0.0)
    assert is_seen(robot, (3000.0, 500.0), WALLS)
    assert not is_seen(robot, (5500.0, 0.0), WALLS), "too far"
    assert not is_seen(robot, (0.0, 800.0), WALLS), "abeam"
    assert not is_seen(robot, (3000.0, 0.0), np.array([[1000.0, -200.0, 1000.0, 200.0]]))
    assert is_seen(robot, (3000.0, 0.0), np.array([[1000.0, 100.0, 1000.0, 400.0]]))


def test_a_journey_among_people_splits_its_contacts() -> None:
    record, outcome_ = run_case(parse_id("ideal/tune/rooms+people/lab/1"))
    people = record["met_ahead"] + record["walked_into"]
    assert people + len(record["collisions"]) + record["struck"] >= len(outcome_.collisions)
