# SPDX-License-Identifier: MIT
"""Rule: all policies drive the same run, from an id alone; what is asked for wrongly is said in one line."""

from __future__ import annotations

import dataclasses

import pytest

from hil_sim.errors import SimError
from hil_sim.experiment.cases import (
    POLICIES,
    WORLDS,
    Case,
    count_dead,
    course_mm,
    dead_sets,
    make_cases,
    mission_of,
    parse_dead,
    parse_id,
)


def test_there_are_63_sets() -> None:
    sets = dead_sets()
    assert len(set(sets)) == 63
    assert [count_dead(name) for name in sets] == sorted(len(name.split("+")) for name in sets)


def test_the_whole_study_has_every_case_once() -> None:
    cases = make_cases(POLICIES, WORLDS, range(1, 11), parse_dead("all"))
    assert len({case.id for case in cases}) == len(cases) == 66 * 5 * 6 * 10
    assert all(parse_id(case.id) == case for case in cases[:500])


def test_policies_meet_the_same_run() -> None:
    missions = [mission_of(Case(policy, "judge", "lab", 3, "2+5", "plain")) for policy in POLICIES]
    assert len({dataclasses.replace(mission, config={}) for mission in missions}) == 1
    assert len({mission.config for mission in missions}) == len(POLICIES)
    assert missions[0].faults == ("off:2+5",)


@pytest.mark.parametrize("world", WORLDS)
def test_a_course_has_5_to_10_m(world: str) -> None:
    case = Case("adaptive", "judge", world, 2, "none", "plain")
    assert 5000 <= course_mm(case) <= 10_000
    assert mission_of(case).faults == ()
    other = dataclasses.replace(case, seed=3)
    assert mission_of(other).course != mission_of(case).course


@pytest.mark.parametrize("text", ["7", "2+1", "1+1", "seven", "front+1"])
def test_no_set_of_dead_sonars(text: str) -> None:
    with pytest.raises(SimError, match="is no set of dead sonars"):
        parse_dead(text)


@pytest.mark.parametrize(
    "text",
    ["", "adaptive/judge/office/3/1+2", "nobody/judge/lab/1/none/plain", "paper/judge/hall/1/none/plain",
     "paper/judge/lab/1/2+1/plain", "paper/judge/lab/x/none/plain", "paper/judge/lab/1/none/stormy"],
)  # fmt: skip
def test_no_id(text: str) -> None:
    with pytest.raises(SimError, match="is no id of a journey"):
        parse_id(text)
