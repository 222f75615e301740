# SPDX-License-Identifier: MIT
"""Rule (S3, S6): without link or program the robot stands in time, and drives on only after a full check."""

from __future__ import annotations

import signal
import time

import pytest
from harness import PATIENCE_S, SIP_S, Argusd, Bench, Record, Sim
from rules import (
    JITTER_S,
    assert_no_move_sent,
    assert_only,
    assert_reached,
    assert_still_between,
    assert_stops_in_time,
    cruise,
)
from worlds import hall

GOAL_MM = 1700


def assert_checked_first(sim: Sim, argusd: Argusd, rest: Record, after_t: float) -> float:
    """No translation between the rest and the health check; return the wall clock of the check."""
    check = argusd.wait("HEALTH_CHECK", after_t=after_t)
    check_unix = argusd.unix(check)
    sim.wait("the check is in the truth", lambda s: s["t_s"] > sim.robot_time(check_unix))
    assert_still_between(sim, rest["t_s"], sim.robot_time(check_unix) - JITTER_S)
    return check_unix


@pytest.mark.parametrize("seconds", [3, 8])
def test_cut_in_motion_and_restored(bench: Bench, seconds: float) -> None:
    sim = bench.sim(bench.world(**hall()))
    tap = bench.tap()
    argusd = bench.argusd("--goal", f"{GOAL_MM},0", link=f"serial:{tap.address}@9600")
    cruise(sim)
    cut_unix = time.time()
    tap.connected = False
    cut_s = sim.robot_time(cut_unix)
    rest = assert_stops_in_time(sim, cut_s)
    sim.wait("the cut ends", lambda s: s["t_s"] > cut_s + seconds)
    cut_t = argusd.wait("LINK_STALLED")["t"]
    tap.connected = True
    back_unix = time.time()
    argusd.wait("LINK_RESUMED" if seconds < 4 else "SESSION_OPEN", after_t=cut_t)
    check_unix = assert_checked_first(sim, argusd, rest, cut_t)
    assert_no_move_sent(tap, back_unix, check_unix - JITTER_S)
    argusd.wait("GOAL_REACHED")
    assert_only(argusd)
    assert argusd.wait_exit() == 0
    assert_reached(sim, GOAL_MM)


def test_cut_by_the_emulator(bench: Bench) -> None:
    """The same as a link fault of the emulator, which users have without a tap."""
    sim = bench.sim(bench.world(**hall()), "link-cut@6s-9s")
    argusd = bench.argusd("--goal", f"{GOAL_MM},0")
    stalled = argusd.wait("LINK_STALLED")
    cut_s = next(r["t_s"] for r in sim.of("link") if r["on"])
    rest = assert_stops_in_time(sim, cut_s)
    assert_checked_first(sim, argusd, rest, stalled["t"])
    argusd.wait("GOAL_REACHED")
    assert argusd.wait_exit() == 0
    assert_reached(sim, GOAL_MM)


def test_host_frozen_in_motion(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()))
    argusd = bench.argusd("--goal", f"{GOAL_MM},0")
    cruise(sim)
    frozen_unix = argusd.signal(signal.SIGSTOP)
    frozen_t = argusd.status["t"] - (argusd.status["unix"] - frozen_unix)
    rest = assert_stops_in_time(sim, sim.robot_time(frozen_unix))
    argusd.signal(signal.SIGCONT)
    assert_checked_first(sim, argusd, rest, frozen_t)
    argusd.wait("GOAL_REACHED")
    assert argusd.wait_exit() == 0
    assert_reached(sim, GOAL_MM)


def test_killed_in_motion_and_a_second_argusd_goes_on(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()))
    first = bench.argusd("--goal", f"{GOAL_MM},0")
    cruise(sim)
    rest = assert_stops_in_time(sim, sim.robot_time(first.signal(signal.SIGKILL)))
    assert sim.of("watchdog"), "nothing but the watchdog can have stopped it"
    second = bench.argusd("--goal", "400,0")
    second.wait("SESSION_OPEN")
    assert second.named("SESSION_DISLODGED"), "the old session was still open"
    assert_checked_first(sim, second, rest, 0.0)
    second.wait("GOAL_REACHED")
    assert second.wait_exit() == 0
    assert_reached(sim, rest["x_mm"] + 400)


def test_a_robot_that_restarts_in_motion_ends_the_course(bench: Bench) -> None:
    """How far it rolled before it restarted nobody knows, so a goal by its figures may be none."""
    world = bench.world(**hall())
    sim = bench.sim(world)
    argusd = bench.argusd("--goal", f"{GOAL_MM},0")
    cruise(sim)
    sim.kill()
    lost = argusd.wait("LINK_LOST")
    again = bench.sim(world)
    argusd.wait("ODOMETRY_LOST", after=lost)
    assert argusd.process.wait(PATIENCE_S) == 1
    assert argusd.named("MISSION_FAILED")
    assert not argusd.named("GOAL_REACHED")
    assert all(abs(state["x_mm"]) < 5 for state in again.of("state"))


def test_emulator_killed_at_rest_and_started_again(bench: Bench) -> None:
    world = bench.world(**hall())
    sim = bench.sim(world)
    argusd = bench.argusd("--goal", f"{GOAL_MM},0")
    argusd.wait("SESSION_OPEN")  # and now it stands and checks its sonars
    sim.kill()
    assert sim.of("state")[-1]["v_mm_s"] == 0
    lost = argusd.wait("LINK_LOST")
    again = bench.sim(world)
    argusd.wait("LINK_UP", after=lost)
    argusd.wait("SESSION_OPEN", after=lost)
    assert_checked_first(again, argusd, again.of("state")[0], lost["t"])
    # The new robot stands at the start of its world; what was driven before is argusd's to remember.
    cruise(again, x_mm=50)
    argusd.wait("GOAL_REACHED")
    assert argusd.process.wait(PATIENCE_S) == 0
    again.wait_rest()
    again.assert_no_collision()


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT], ids=["SIGTERM", "SIGINT"])
def test_signal_in_motion_stops_then_closes_in_order(bench: Bench, number: int) -> None:
    sim = bench.sim(bench.world(**hall()))
    tap = bench.tap()
    argusd = bench.argusd("--goal", f"{GOAL_MM},0", link=f"serial:{tap.address}@9600")
    cruise(sim)
    asked_unix = argusd.signal(number)
    assert argusd.wait_exit() == 0
    assert argusd.named("SESSION_CLOSED")
    closed = sim.of("session")[-1] if sim.of("session")[-1]["state"] == "closed" else None
    if closed is None:
        sim.wait("the session closes", lambda s: sim.of("session")[-1]["state"] == "closed")
        closed = sim.of("session")[-1]
    assert closed["reason"] == "close"
    assert closed["t_s"] - sim.robot_time(asked_unix) <= 4.0
    before = max((s for s in sim.of("state") if s["t_s"] <= closed["t_s"]), key=lambda s: float(s["t_s"]))
    assert abs(before["v_mm_s"]) <= 1, "the session was closed in motion"
    sent = [h for h in tap.commands(asked_unix) if h.name != "PULSE"]
    if sent[0].name == "MOVE" and sent[0].unix_s - asked_unix <= SIP_S:
        del sent[0]  # was on the wire when the signal came
    names = [h.name for h in sent]
    assert names[0] == "STOP", names
    assert names[-1] == "CLOSE", names
    assert names.count("CLOSE") == 1
    off = next(k for k, h in enumerate(sent) if h.name == "SONAR" and h.value == 0)
    assert "STOP" in names[off:], names
    assert "MOVE" not in names, names
    sim.assert_no_collision()


@pytest.mark.long
def test_a_noisy_cable_delays_but_does_not_mislead(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()), "link-corrupt@3s:p=0.2", "link-drop@3s:p=0.02", seed=5)
    argusd = bench.argusd("--goal", "1200,0")
    argusd.wait("GOAL_REACHED")
    assert argusd.wait_exit() == 0
    last = argusd.status  # the one that comes after the last event
    assert last["bad_checksums"] + last["skipped_bytes"] > 0, "the noise did not arrive"
    assert_only(argusd)
    assert_reached(sim, 1200)


def test_an_end_that_the_robot_may_not_have_heard_is_no_orderly_one(bench: Bench) -> None:
    """What is written into a dead cable is not said: the exit code is that of an unclean end."""
    bench.sim(bench.world(**hall()), "link-cut@3s-60s")
    argusd = bench.argusd()
    argusd.wait("LINK_STALLED")
    argusd.signal(signal.SIGINT)
    assert argusd.wait_exit() == 6
    assert any("may not have heard the end" in line for line in argusd.errors)


@pytest.mark.parametrize("cut_s", [-0.2, 0.05, 0.4])
def test_a_cable_that_dies_about_the_end_makes_it_unclean(bench: Bench, cut_s: float) -> None:
    """The silence is too short to be one yet when the end is asked for, or begins before the robot rests."""
    sim = bench.sim(bench.world(**hall()))
    tap = bench.tap()
    argusd = bench.argusd("--goal", f"{GOAL_MM},0", link=f"serial:{tap.address}@9600")
    cruise(sim)
    if cut_s > 0:
        argusd.signal(signal.SIGINT)
        time.sleep(cut_s)
    tap.connected = False
    if cut_s < 0:
        time.sleep(-cut_s)
        argusd.signal(signal.SIGINT)
    assert argusd.wait_exit() == 6
    assert any("may not have heard the end" in line for line in argusd.errors)
    sim.wait_rest()
    sim.assert_no_collision()


def test_a_cable_that_died_while_passive_makes_the_end_unclean(bench: Bench) -> None:
    bench.sim(bench.world(**hall()))
    tap = bench.tap()
    argusd = bench.argusd(link=f"serial:{tap.address}@9600", active=False)
    argusd.wait("HEALTH_CHECK")
    tap.connected = False
    time.sleep(0.2)
    argusd.signal(signal.SIGINT)
    assert argusd.wait_exit() == 6
    assert any("may not have heard the end" in line for line in argusd.errors)
