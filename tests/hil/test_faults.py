# SPDX-License-Identifier: MIT
"""Rule (S1, S2, S6): a sonar that fails is found, after its fault and by kind; no healthy one is disabled."""

from __future__ import annotations

import pytest
from harness import Bench, is_at_rest, is_translating, way_mm
from rules import OFF, WRONG, assert_after_injection, assert_only, assert_reached, injected_s, name
from worlds import hall

pytestmark = pytest.mark.monitored


def test_dead_while_idle_is_disabled_and_planned_for_without_a_move(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()), "off:2@5s")
    argusd = bench.argusd()
    argusd.wait("HEALTH_CHECK")
    disabled = argusd.wait("SONAR_DISABLED", name=name(2), value=OFF)
    dead = argusd.wait("SONAR_DEAD", name=name(2), value=5000)
    assert abs(argusd.wait("STOPPED")["t"] - dead["t"]) <= 0.001, "STOP belongs into the SIP that shows it"
    argusd.wait("PLAN")
    argusd.wait("PLAN_ROTATION")
    argusd.wait("HEALTH_CHECK", value=1)
    assert_after_injection(sim, argusd, disabled)
    assert_only(argusd, (2, OFF))
    states = sim.of("state")
    assert way_mm(states[0], states[-1]) < 1.0
    assert not any(map(is_translating, states))


def test_dead_before_the_start_is_swept_for_before_the_first_step(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()), "off:5@0s")
    argusd = bench.argusd("--goal", "450,0")
    argusd.wait("SONAR_DISABLED", name=name(5), value=OFF)
    sweep = argusd.wait("SWEEP")
    argusd.wait("GOAL_REACHED")
    swept_s = sim.robot_time(argusd.unix(sweep))
    first = next(s for s in sim.of("state") if is_translating(s))
    assert first["t_s"] >= swept_s - 0.1, "drives before it has looked where sonar 5 cannot"
    assert_only(argusd, (5, OFF))
    assert argusd.wait_exit() == 0
    assert_reached(sim, 450)


def test_dead_in_motion_is_stopped_for_disabled_and_planned_for(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()), "off:3@x>400")
    argusd = bench.argusd("--goal", "900,0")
    disabled = argusd.wait("SONAR_DISABLED", name=name(3), value=OFF)
    assert_after_injection(sim, argusd, disabled)
    dead = argusd.wait("SONAR_DEAD", name=name(3))
    assert abs(argusd.wait("STOPPED", after_t=dead["t"] - 0.001)["t"] - dead["t"]) <= 0.001
    argusd.wait("PLAN", after_t=dead["t"])
    step = argusd.wait("STEP", after_t=dead["t"])
    sweep = argusd.wait("SWEEP", after_t=dead["t"])
    assert sweep["t"] <= step["t"], "steps before it has looked"
    rest = next(s for s in sim.of("state", injected_s(sim)) if is_at_rest(s))
    assert rest["t_s"] < sim.robot_time(argusd.unix(sweep)), "stands before it sweeps"
    argusd.wait("GOAL_REACHED")
    assert_only(argusd, (3, OFF))
    assert argusd.wait_exit() == 0
    assert_reached(sim, 900)


def test_a_sonar_that_reads_half_is_proven_wrong_and_disabled(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()), "wrong:6@x>300:scale=0.5")
    argusd = bench.argusd("--goal", "900,0")
    suspect = argusd.wait("SONAR_SUSPECT", name=name(6))
    disabled = argusd.wait("SONAR_DISABLED", name=name(6), value=WRONG)
    assert_after_injection(sim, argusd, disabled)
    witnesses = [e["name"] for e in argusd.named("SONAR_WITNESS") if suspect["t"] <= e["t"] <= disabled["t"]]
    assert witnesses == [name(5)], "its neighbour was turned onto its bearing"
    argusd.wait("PLAN", after_t=suspect["t"])
    argusd.wait("GOAL_REACHED")
    assert_only(argusd, (6, WRONG))
    assert argusd.wait_exit() == 0
    assert_reached(sim, 900)


def test_healthy_sonars_beside_a_wall_are_suspected_cleared_and_kept(bench: Bench) -> None:
    wall = {"centre": [600, 900], "size": [1400, 200]}
    sim = bench.sim(bench.world(**hall(boxes=[wall])))
    argusd = bench.argusd("--goal", "700,0")
    argusd.wait("GOAL_REACHED")
    assert argusd.named("SONAR_SUSPECT"), "the wall beside makes an edge sonar disparate"
    assert argusd.named("SONAR_CLEARED")
    assert_only(argusd)
    assert argusd.wait_exit() == 0
    assert_reached(sim, 700)
