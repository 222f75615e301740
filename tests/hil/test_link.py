# SPDX-License-Identifier: MIT
"""Rule (S3): whatever becomes of link or programs, the robot stands in time and drives on only after a full health check."""

from __future__ import annotations

import signal
import time

from harness import SIP_S, Argusd, Bench, Record, Sim, is_at_rest, is_translating, way_mm
from worlds import hall

GOAL = "2000,0"
CRUISE_MM_S = 190.0
BRAKES_WITHIN_S = 2.0
STANDS_WITHIN_S = 2.7
STANDS_WITHIN_MM = 467.0
ODOMETRY_MM = 20.0


def cruise(sim: Sim, x_mm: float = 300.0) -> Record:
    """Wait until it drives at full speed with room ahead."""
    return sim.wait("it drives", lambda s: s["v_mm_s"] > CRUISE_MM_S and s["x_mm"] > x_mm, 40.0)


def assert_stops_in_time(sim: Sim, silent_s: float) -> Record:
    """S3 on the emulator's own clock, from the moment the robot heard nothing more; return the state in which it stands."""
    sim.wait("time for the bound", lambda s: s["t_s"] > silent_s + STANDS_WITHIN_S + SIP_S)
    states = sim.of("state")
    before = max((s for s in states if s["t_s"] <= silent_s), key=lambda s: s["t_s"])
    brakes = next((s for s in states if s["t_s"] > silent_s and s["v_mm_s"] < before["v_mm_s"] - 10), None)
    assert brakes is not None, "it never brakes"
    assert brakes["t_s"] - silent_s <= BRAKES_WITHIN_S + SIP_S + 0.05, f"brakes {brakes['t_s'] - silent_s:.2f} s later"
    rest = next((s for s in states if s["t_s"] > silent_s and is_at_rest(s)), None)
    assert rest is not None, "it never stands"
    # A state is written each 100 ms: rest may be seen that much late.
    assert rest["t_s"] - silent_s <= STANDS_WITHIN_S + SIP_S, f"stands {rest['t_s'] - silent_s:.2f} s later"
    assert way_mm(before, rest) <= STANDS_WITHIN_MM + ODOMETRY_MM, f"stands {way_mm(before, rest):.0f} mm farther"
    return rest


def test_kill_in_motion_robot_stands_and_a_second_argusd_goes_on(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()))
    first = bench.argusd("--goal", GOAL)
    cruise(sim)
    silent_s = sim.robot_time(first.signal(signal.SIGKILL))
    rest = assert_stops_in_time(sim, silent_s)
    second = bench.argusd("--goal", "500,0")
    check = second.wait("HEALTH_CHECK")
    assert second.named("SESSION_DISLODGED"), "the old session was still open"
    checked_s = sim.robot_time(second.unix(check))
    early = [s for s in sim.of("state", rest["t_s"]) if is_translating(s) and s["t_s"] < checked_s]
    assert not early, f"moves before the health check: {early[0]}"
    second.wait("GOAL_REACHED", timeout_s=40)
    assert second.wait_exit() == 0
    sim.assert_no_collision()
