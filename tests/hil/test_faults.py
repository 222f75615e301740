# SPDX-License-Identifier: MIT
"""Rule (S1, S2, S6): a sonar that fails is found after its fault and by its kind, no healthy one is disabled, nothing is hit."""

from __future__ import annotations

import pytest
from harness import Argusd, Bench, Record, Sim, is_at_rest
from worlds import hall

OFF, WRONG = 1, 4
GOAL = "1900,0"


def name(sonar: int) -> str:
    return f"sonar/front/{sonar:02}"


def injected_s(sim: Sim) -> float:
    """Robot time at which the first fault began."""
    return float(next(r["t_s"] for r in sim.of("fault") if r["active"]))


def assert_only(argusd: Argusd, *expected: tuple[int, int]) -> None:
    """Diagnosis equals injection: sonars and kinds, and no other was ever disabled."""
    disabled = [(e["name"], e["value"]) for e in argusd.named("SONAR_DISABLED")]
    assert sorted(disabled) == sorted((name(sonar), kind) for sonar, kind in expected)


def assert_after_injection(sim: Sim, argusd: Argusd, event: Record) -> None:
    assert sim.robot_time(argusd.unix(event)) > injected_s(sim) - 0.05


def test_sonar_dead_in_motion_is_stopped_for_disabled_and_planned_for(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()), "off:3@x>500")
    argusd = bench.argusd("--goal", "1100,0")
    disabled = argusd.wait("SONAR_DISABLED", timeout_s=40)
    assert_after_injection(sim, argusd, disabled)
    dead = argusd.wait("SONAR_DEAD", name=name(3))
    stopped = argusd.wait("STOPPED", after_t=dead["t"] - 0.01)
    assert stopped["t"] - dead["t"] <= 0.001, "STOP belongs into the SIP that shows the dead reading"
    argusd.wait("PLAN", after_t=dead["t"])
    argusd.wait("STEP", after_t=dead["t"])
    first_sweep = argusd.wait("SWEEP", after_t=dead["t"])
    rest = [s for s in sim.of("state") if is_at_rest(s) and injected_s(sim) < s["t_s"]]
    assert rest[0]["t_s"] < sim.robot_time(argusd.unix(first_sweep)), "it stands before it sweeps"
    argusd.wait("GOAL_REACHED", timeout_s=60)
    assert_only(argusd, (3, OFF))
    assert argusd.wait_exit() == 0
    sim.assert_no_collision()
