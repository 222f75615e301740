# SPDX-License-Identifier: MIT
"""Rule: each robot that is known is driven with its own body and sonars; one that is not is never moved."""

from __future__ import annotations

import pytest
from harness import Argusd, Bench, Sim, is_at_rest
from rules import OFF, assert_only, assert_reached
from worlds import hall

pytestmark = pytest.mark.monitored

GOAL_MM = 900
SONARS = 16
SETTLE_S = 12.0
ROBOTS = {"p3dx-sh": (3, 16), "p3at-sh": (3, 16), "amigo-sh": (2, 8)}


def start(bench: Bench, robot: str, *faults: str, more: tuple[str, ...] = ()) -> Sim:
    world = bench.world(**hall())
    return bench.sim(world, *faults, extra=("--robot", robot, *more))


def assert_never_moved(sim: Sim, argusd: Argusd) -> None:
    """For some seconds after it knew whom it met."""
    until_s = sim.t_s + SETTLE_S
    sim.wait("time in which it might have driven", lambda s: s["t_s"] > until_s)
    assert all(is_at_rest(state) for state in sim.of("state"))
    assert not argusd.named("SONAR_DISABLED", "SONAR_SUSPECT", "GOAL_REACHED")
    assert argusd.status["active"] is False


@pytest.mark.long
@pytest.mark.parametrize("robot", ROBOTS)
def test_driven_to_a_goal_with_a_dead_sonar(bench: Bench, robot: str) -> None:
    dead, sonars = ROBOTS[robot]
    sim = start(bench, robot, f"off:{dead}@0s")
    argusd = bench.argusd("--goal", f"{GOAL_MM},0")
    argusd.wait("GOAL_REACHED")
    health = argusd.status["health"]
    assert argusd.wait_exit() == 0
    assert_reached(sim, GOAL_MM)
    assert_only(argusd, (dead, OFF))
    assert argusd.named("SWEEP"), "it drove as if nothing were wrong"
    assert health[dead] == "DISABLED"
    assert health[sonars:] == ["ABSENT"] * (SONARS - sonars)
    assert "ABSENT" not in health[:sonars]
    assert not argusd.named("SUBCLASS_UNKNOWN")


def assert_failed(argusd: Argusd, barred: str) -> None:
    """A mission that cannot begin ends, and all that look on get the reason."""
    argusd.wait("MISSION_FAILED")
    assert argusd.wait_exit() == 1
    assert (argusd.status["mission"], argusd.status["barred"]) == ("failed", barred)


def test_settings_that_are_unsafe_for_a_robot_fail_its_mission(bench: Bench) -> None:
    """A PeopleBot's body reaches 91 mm beyond its sonars."""
    sim = start(bench, "peoplebot-sh")
    argusd = bench.argusd("--goal", f"{GOAL_MM},0", config={"speed_mm_s": 200, "object_range_mm": 250})
    argusd.wait("ROBOT_UNSAFE")
    assert_failed(argusd, "unsafe")
    assert "peoplebot-sh: driving would be unsafe (S5): overhang 91" in "".join(argusd.errors)
    assert_never_moved(sim, argusd)


def test_an_unknown_robot_is_never_moved(bench: Bench) -> None:
    sim = start(bench, "p3dx-sh", more=("--subclass", "powerbot-sh"))
    argusd = bench.argusd("--goal", f"{GOAL_MM},0")
    argusd.wait("SUBCLASS_UNKNOWN")
    assert_failed(argusd, "unknown")
    assert_never_moved(sim, argusd)
    assert argusd.status["health"] == ["ABSENT"] * SONARS
    assert len(argusd.named("SUBCLASS_UNKNOWN")) == 1


def test_an_unknown_robot_is_driven_when_the_operator_says_which_it_is(bench: Bench) -> None:
    sim = start(bench, "p3dx-sh", more=("--subclass", "powerbot-sh"))
    argusd = bench.argusd("--goal", f"{GOAL_MM},0", "--robot", "p3dx-sh")
    argusd.wait("GOAL_REACHED")
    assert argusd.wait_exit() == 0
    assert_reached(sim, GOAL_MM)
    assert not argusd.named("SUBCLASS_UNKNOWN")
