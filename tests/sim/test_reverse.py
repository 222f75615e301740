# SPDX-License-Identifier: MIT
"""Rule: the front array fails at once on the way: no living sonar is named or given up for disagreeing with it, the
robot turns about once, drives on with its rear ahead, reaches its goal and hits nothing; the front leads again when it
has recovered."""

from __future__ import annotations

import dataclasses

import pytest

from hil_sim.sil import Mission, Outcome, Sil

COURSES = {
    "office": ((2300.0, 1000.0), (0.0, 0.0)),
    "lab": ((1700.0, 1900.0), (0.0, 0.0)),
    "corridor": ((7000.0, 0.0),),
}
FRONT = set(range(8))


def lost(world: str, faults: str, *, seed: int = 1, limit_s: float = 120.0) -> Mission:
    """Return a mission whose front array fails as FAULTS says."""
    return Mission(world, COURSES[world], faults=(faults,), seed=seed, limit_s=limit_s)


def ends(outcome: Outcome) -> list[int]:
    """Return which end led, as the events say: 1 the rear."""
    return [event.value for event in outcome.events if event.name == "REVERSED"]


@pytest.mark.tour(2)
@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("world", sorted(COURSES))
def test_the_rear_leads_to_the_goal_when_the_front_array_is_lost(world: str, seed: int) -> None:
    outcome = Sil(lost(world, "off:front@6s", seed=seed)).run()
    story = f"{world}, seed {seed}: {[(round(e.t_s, 1), e.name, e.sonar, e.value) for e in outcome.events]}"
    assert outcome.reached, story
    assert not outcome.collisions, story
    assert ends(outcome) == [1], story
    told = [e for e in outcome.events if e.name in ("SONAR_NAMED", "SONAR_DISABLED")]
    assert {e.sonar for e in told} <= FRONT, story
    assert {e.sonar for e in told if e.name == "SONAR_DISABLED"} == FRONT, story


def test_the_front_leads_again_when_it_has_recovered() -> None:
    course = ((1700.0, 1900.0), (0.0, 0.0)) * 4
    outcome = Sil(Mission("lab", course, faults=("off:front@6s-20s",), limit_s=400)).run()
    story = [(round(e.t_s, 1), e.name, e.sonar, e.value) for e in outcome.events]
    assert ends(outcome) == [1, 0], story
    assert not outcome.collisions, story
    assert outcome.reached or outcome.goal_mm < 500, story


def test_under_the_papers_rules_the_front_alone_leads() -> None:
    mission = dataclasses.replace(lost("lab", "off:front@6s", limit_s=40), config={"profile": "paper"})
    outcome = Sil(mission).run()
    assert ends(outcome) == []
    assert "MISSION_FAILED" in [e.name for e in outcome.events]


def test_a_front_that_is_merely_in_the_open_is_not_given_up() -> None:
    outcome = Sil(Mission("hall", ((9000.0, 0.0), (0.0, 3000.0)), limit_s=90)).run()
    assert [e.name for e in outcome.events if e.name in ("SONAR_DISABLED", "REVERSED")] == []
