# SPDX-License-Identifier: MIT
"""Rule (S2, S7): a bumper is answered by E_STOP, then backing off 150 mm and a full check, or by waiting."""

from __future__ import annotations

import pytest
from harness import SIP_S, Bench, Sim, Tap, is_at_rest, is_translating, way_mm
from rules import assert_only, assert_reached
from worlds import hall

from hil_sim.arcos import COMMAND, TYPE, Sip

pytestmark = pytest.mark.monitored

BACK_OFF_MM = 150


def pressed_s(sim: Sim) -> float:
    """Robot time at which the bumper was hit, in motion."""
    hit = next(r for r in sim.of("bumper") if r["front"])
    before = max((s for s in sim.of("state") if s["t_s"] <= hit["t_s"]), key=lambda s: float(s["t_s"]))
    assert before["v_mm_s"] > 100, "the hit was meant to come in motion; choose another time"
    return float(hit["t_s"])


def assert_answered_by_estop(tap: Tap) -> None:
    """The first packet that follows the first SIP with a bumper bit is E_STOP."""
    sip_types = (TYPE["SIP_MOVING"], TYPE["SIP_STATIONARY"])
    heard = list(tap.heard)
    at = next(
        k for k, h in enumerate(heard)
        if not h.to_robot and h.data[0] in sip_types and Sip.decode(h.data).stall_right & 0x3E
    )  # fmt: skip
    answer = next(h for h in heard[at:] if h.to_robot)
    assert answer.data[0] == COMMAND["E_STOP"], f"answered by {answer.name}"


@pytest.mark.long
def test_hit_in_motion_stops_backs_off_checks_and_goes_on(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()), "bumper:3@6s-8s")
    tap = bench.tap()
    argusd = bench.argusd("--goal", "1500,0", link=f"serial:{tap.address}@9600")
    bumper = argusd.wait("BUMPER")
    backing = argusd.wait("BACKING", value=BACK_OFF_MM)
    check = argusd.wait("HEALTH_CHECK", after_t=backing["t"])
    hit_s, backing_s = pressed_s(sim), sim.robot_time(argusd.unix(backing))
    assert_answered_by_estop(tap)
    rest = next(s for s in sim.of("state", hit_s) if is_at_rest(s))
    assert rest["t_s"] <= max(hit_s + 5 * SIP_S, backing_s), "it stands before it backs off"
    backed = next(s for s in sim.of("state", backing_s + 0.5) if is_at_rest(s))
    assert abs(way_mm(rest, backed) - BACK_OFF_MM) <= 20
    assert backed["x_mm"] < rest["x_mm"]
    ahead = [s for s in sim.of("state", hit_s) if s["v_mm_s"] > 5 and s["t_s"] > rest["t_s"]]
    assert not [s for s in ahead if s["t_s"] < sim.robot_time(argusd.unix(check))], (
        "drives on before the check"
    )
    assert bumper["value"] >> 8 == 1 << 3
    argusd.wait("GOAL_REACHED")
    assert_only(argusd)
    assert argusd.wait_exit() == 0
    assert_reached(sim, 1500)


@pytest.mark.long
def test_hit_with_the_rear_blocked_waits_and_says_so_each_10_s(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()), "bumper:3@6s-28s", "stuck:11@0s:value=300")
    argusd = bench.argusd("--goal", "1500,0")
    argusd.wait("BUMPER")
    says = [argusd.wait("WAITING", value=value) for value in (0, 10, 20)]
    assert not argusd.named("BACKING")
    hit_s = pressed_s(sim)
    waiting = [
        s for s in sim.of("state", hit_s + 5 * SIP_S) if s["t_s"] < sim.robot_time(argusd.unix(says[-1]))
    ]
    assert waiting
    assert not any(map(is_translating, waiting))
    assert not any(abs(s["w_deg_s"]) > 1 for s in waiting), "turns with a bumper pressed"
    clear = argusd.wait("BUMPER_CLEAR")
    argusd.wait("HEALTH_CHECK", after_t=clear["t"])
    argusd.wait("GOAL_REACHED")
    assert argusd.wait_exit() == 0
    assert_reached(sim, 1500)
