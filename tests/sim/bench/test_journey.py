# SPDX-License-Identifier: MIT
"""Rule: an id is the whole of a journey, and driver and conditions change nothing but themselves."""

from __future__ import annotations

import dataclasses

import pytest
from bench.processes import outputs

from hil_sim.bench import journey, plan
from hil_sim.bench.journey import (
    DEFAULT_ROWS,
    IDEAL,
    Case,
    faults_of,
    make_cases,
    mission_of,
    parse_id,
    parse_row,
)
from hil_sim.bench.journey_course import length_mm
from hil_sim.errors import SimError
from hil_sim.faults.grammar import parse_fault
from hil_sim.faults.kinds import SonarFault

IDS = (
    "argus/tune/rooms+people/office/7",
    "paper/judge/rooms+one/lab/3",
    "argus:caution=200/tune/pairs+two+start/pairs-2/5",
    "ideal/judge/doors+mobilesim/doors-4/2",
)


def case(text: str) -> Case:
    return parse_id(text)


def test_an_id_is_the_case_it_names() -> None:
    cases = make_cases(["argus", "paper"], "judge", DEFAULT_ROWS, range(1, 3))
    assert len({one.id for one in cases}) == len(cases) > 200
    for one in cases:
        assert parse_id(one.id) == one


@pytest.mark.soak
def test_an_id_gives_the_same_mission_in_any_process() -> None:
    program = (
        "import sys; from hil_sim.bench.journey import mission_of, parse_id\n"
        "for name in sys.argv[1:]:\n"
        "    m = mission_of(parse_id(name))\n"
        "    print(m.course, m.start, m.faults, m.seed, m.movers, m.physics, m.quirks, dict(m.config))\n"
    )
    runs = outputs(program, IDS)
    assert len(runs) == 1
    for name, line in zip(IDS, runs.pop().splitlines(), strict=True):
        mission = mission_of(parse_id(name))
        assert str(mission.faults) in line, name
        assert str(mission.seed) in line, name


@pytest.mark.parametrize(
    "text", ["argus/tune/rooms+one/office/3", "paper/judge/maps+front+rough/map-floor/2"]
)
def test_the_ideal_is_the_same_mission_without_faults_and_diagnosis(text: str) -> None:
    mission, ideal = mission_of(case(text)), mission_of(case(text).ideal)
    assert mission.faults
    assert not ideal.faults
    assert ideal.config["diagnosis"] == "off"
    assert dataclasses.replace(mission, faults=(), config=ideal.config) == ideal


def test_conditions_change_nothing_but_themselves() -> None:
    plain = mission_of(case("argus/tune/rooms/lab/4"))
    rough = mission_of(case("argus/tune/rooms+rough/lab/4"))
    people = mission_of(case("argus/tune/rooms+people/lab/4"))
    emulator = mission_of(case("argus/tune/rooms+mobilesim/lab/4"))
    assert dataclasses.replace(rough, physics="", course=plain.course) == plain
    assert rough.course != plain.course  # more drift leaves less room
    assert rough.physics == "rough-day"
    assert dataclasses.replace(people, movers=()) == plain
    assert people.movers
    assert dataclasses.replace(emulator, quirks="robot") == plain
    assert emulator.quirks == "mobilesim"


@pytest.mark.soak
def test_the_splits_share_nothing_that_is_drawn() -> None:
    for row, world in (
        ("rooms+one+people", "office"),
        ("rooms", "gen-hall"),
        ("doors", "doors-2"),
        ("pairs", "pairs-1"),
    ):
        tune, judge = (mission_of(Case("argus", split, row, world, 1)) for split in plan.SPLITS)
        assert tune.seed != judge.seed, row
        assert tune.course != judge.course, row
        assert not set(tune.movers) & set(judge.movers), row


def test_a_fault_comes_midway_or_is_there_from_the_start() -> None:
    for seed in range(1, 15):
        one = Case("argus", "tune", "rooms+one", "office", seed)
        mission = mission_of(one)
        fault = sonar_fault(mission.faults[0])
        whole = length_mm((0.0, 0.0), mission.course)
        assert fault.start is not None
        assert fault.start.variable == "travelled"
        assert 0.29 * whole <= fault.start.value <= 0.61 * whole, one.id
        early = sonar_fault(faults_of(dataclasses.replace(one, row="rooms+one+start"))[0])
        assert early.start is None
        assert dataclasses.replace(fault, start=None, text=early.text) == early, one.id


def sonar_fault(text: str) -> SonarFault:
    fault = parse_fault(text)
    assert isinstance(fault, SonarFault)
    return fault


def test_each_kind_comes_up_and_two_faults_are_of_two_sonars() -> None:
    kinds = set()
    for seed in range(1, 8):
        first, second = (sonar_fault(t) for t in faults_of(Case("argus", "tune", "rooms+two", "lab", seed)))
        assert first.sonars != second.sonars, seed
        kinds.add(first.kind)
    assert kinds == set(plan.FAULTS)


@pytest.mark.parametrize(
    ("name", "sonars"),
    [("front", set(range(8))), ("front-slow", set(range(8))), ("front-scaled", set(range(8)))],
)
def test_an_array_is_lost_as_a_whole(name: str, sonars: set[int]) -> None:
    (text,) = faults_of(Case("argus", "tune", f"rooms+{name}+start", "lab", 1))
    assert set(sonar_fault(text).sonars) == sonars


def test_most_leaves_one_of_the_forward_six_and_neighbours_are_side_by_side() -> None:
    for seed in range(1, 8):
        (most,) = faults_of(Case("argus", "tune", "rooms+most", "lab", seed))
        assert len(set(plan.FORWARD) - set(sonar_fault(most).sonars)) == 1, seed
        (both,) = faults_of(Case("argus", "tune", "rooms+neighbours", "lab", seed))
        a, b = sonar_fault(both).sonars
        assert b == a + 1, seed


def test_a_row_has_one_name_in_whatever_order_it_is_written() -> None:
    assert parse_row("rooms+one+rough+start").name == parse_row("rooms+start+rough+one").name
    assert parse_id("argus/tune/rooms+one+rough/lab/1").ideal.row == "rooms+rough"


@pytest.mark.parametrize("text", ["room", "rooms+rain", "rooms+start", "rooms+", "", "+one"])
def test_what_is_no_row_is_refused(text: str) -> None:
    with pytest.raises(SimError, match="row '"):
        parse_row(text)


@pytest.mark.parametrize(
    "text", ["argus/tune/rooms/lab", "argus/other/rooms/lab/1", "", "nobody/tune/rooms/lab/1"]
)
def test_what_is_no_id_is_refused(text: str) -> None:
    with pytest.raises(SimError):
        parse_id(text)


def test_a_world_that_there_is_not_is_named() -> None:
    with pytest.raises(SimError, match="mars"):
        mission_of(Case(IDEAL, "tune", "rooms", "mars", 1))


def test_worlds_of_ones_own_take_the_place_of_rooms_but_not_of_sets() -> None:
    cases = make_cases(["argus"], "tune", ["rooms", "doors"], [1], ["lab"])
    assert {one.world for one in cases if one.row == "rooms"} == {"lab"}
    assert {one.world for one in cases if one.row == "doors"} == set(journey.GROUND["doors"])
