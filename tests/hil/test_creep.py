# SPDX-License-Identifier: MIT
"""Rule (S1): with no sonar left it stands and says why; with leave and a bumper it creeps, and no faster."""

from __future__ import annotations

import pytest
from harness import SIP_S, Bench, Sim, is_at_rest
from rules import assert_reached
from worlds import hall

pytestmark = pytest.mark.monitored

ALL = "+".join(map(str, range(16)))
LOST_S = 6
CREEP_MM_S = 80
GOAL_MM = 1600
STANDS_S = 10.0
TOLERANCE_MM_S = 5


def start(bench: Bench, *more: str) -> Sim:
    """All sonars are silenced on the way, so that what led until then is known."""
    return bench.sim(bench.world(**hall()), f"silent:{ALL}@{LOST_S}s", extra=more)


def test_without_leave_it_stands_and_says_so(bench: Bench) -> None:
    sim = start(bench)
    argusd = bench.argusd("--goal", "2000,0")
    failed = argusd.wait("MISSION_FAILED")
    stood_s = sim.robot_time(argusd.unix(failed)) + 5 * SIP_S
    sim.wait("time in which it might have moved", lambda s: s["t_s"] > stood_s + STANDS_S)
    assert argusd.status["state"] == "IsCatastrophic"
    assert all(is_at_rest(state) for state in sim.of("state", stood_s))
    assert not argusd.named("CREEPING", "GOAL_REACHED")
    sim.assert_no_collision()


@pytest.mark.long
def test_with_leave_it_creeps_to_its_goal(bench: Bench) -> None:
    sim = start(bench)
    argusd = bench.argusd("--goal", f"{GOAL_MM},0", config={"creep_mm_s": CREEP_MM_S})
    creeping = argusd.wait("CREEPING")
    assert creeping["value"] == CREEP_MM_S
    argusd.wait("GOAL_REACHED")
    assert argusd.wait_exit() == 0
    crept = sim.of("state", sim.robot_time(argusd.unix(creeping)) + 5 * SIP_S)
    assert max(abs(state["v_mm_s"]) for state in crept) <= CREEP_MM_S + TOLERANCE_MM_S
    assert any(abs(state["v_mm_s"]) > CREEP_MM_S / 2 for state in crept)
    assert_reached(sim, GOAL_MM)


def test_a_robot_without_bumpers_does_not_creep(bench: Bench) -> None:
    """What leave is given for is not there: its CONFIGpac says so."""
    sim = start(bench, "--bumpers", "0")
    argusd = bench.argusd("--goal", "2000,0", config={"creep_mm_s": CREEP_MM_S})
    argusd.wait("MISSION_FAILED")
    assert not argusd.named("CREEPING", "GOAL_REACHED")
    sim.assert_no_collision()
