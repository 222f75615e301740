# SPDX-License-Identifier: MIT
"""Rule (S1, S2): a box ahead on any sonar's bearing is seen in time: got round or stood before, never hit."""

from __future__ import annotations

import pytest
from harness import Bench, is_translating
from rules import OFF, assert_only, assert_reached
from worlds import hall, hall_with_box

from hil_sim.tables import load

pytestmark = pytest.mark.monitored

BOX_X_MM = 800.0
GOAL_MM = 1700
WALL_MM = 1100
CHECK_RANGE_MM = 350
STEP_MM = 200
NOISE_MM = 20
SONAR_FACE_MM: int = load("robots/p3dx-sh")["body"]["sonar_face_mm"]


@pytest.mark.long
@pytest.mark.parametrize("sonar", range(1, 7))
def test_every_bearing(bench: Bench, sonar: int) -> None:
    sim = bench.sim(bench.world(**hall_with_box(BOX_X_MM, sonar)), seed=sonar)
    argusd = bench.argusd("--goal", f"{GOAL_MM},0")
    seen = argusd.wait("OBJECT", "AVOIDING")
    ended = argusd.wait("GOAL_REACHED", "NO_WAY", "MISSION_FAILED", after_t=seen["t"])
    sim.assert_no_collision()
    assert_only(argusd)
    if ended["event"] == "GOAL_REACHED":
        assert argusd.wait_exit() == 0
        assert_reached(sim, GOAL_MM)
    else:
        sim.wait_rest()


@pytest.mark.long
@pytest.mark.parametrize("sonar", [2, 3, 4, 6])
def test_with_the_two_foremost_sonars_dead(bench: Bench, sonar: int) -> None:
    sim = bench.sim(bench.world(**hall_with_box(BOX_X_MM, sonar)), "off:3+4@0s", seed=sonar)
    argusd = bench.argusd("--goal", f"{GOAL_MM},0")
    seen = argusd.wait("OBJECT_CHECKED", "OBJECT", "AVOIDING")
    # Long enough to come to rest, to choose a way and to start on it, where a bad choice would touch the box.
    until_s = sim.robot_time(argusd.unix(seen)) + 15
    sim.wait("what it does next", lambda s: s["t_s"] > until_s)
    sim.assert_no_collision()
    assert_only(argusd, (3, OFF), (4, OFF))
    first_sweep = argusd.wait("SWEEP")
    moves = [s for s in sim.of("state") if is_translating(s)]
    assert all(s["t_s"] > sim.robot_time(argusd.unix(first_sweep)) - 0.1 for s in moves)
    assert argusd.named("PLAN_ROTATION")


@pytest.mark.long
def test_a_wall_that_only_the_sweep_sees_stops_the_next_step(bench: Bench) -> None:
    """The goal lies so near a wall that the last step before it may not be made."""
    sim = bench.sim(bench.world(**hall(length_mm=WALL_MM)), "off:3+4@0s")
    argusd = bench.argusd("--goal", f"{WALL_MM - 300:.0f},0")
    checked = argusd.wait("OBJECT_CHECKED")
    assert checked["value"] <= CHECK_RANGE_MM
    sim.wait("what it does next", lambda s: s["t_s"] > sim.robot_time(argusd.unix(checked)) + 5)
    farthest_mm = max(s["x_mm"] for s in sim.of("state"))
    assert farthest_mm <= WALL_MM - SONAR_FACE_MM - CHECK_RANGE_MM + STEP_MM + NOISE_MM, (
        "stepped although it saw"
    )
    sim.assert_no_collision()
    assert_only(argusd, (3, OFF), (4, OFF))
