# SPDX-License-Identifier: MIT
"""Rule (S3, S6): a bus that goes away in motion makes the robot stand, and it drives on only after a full check."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pytest
from canbus import interface, ip, running, set_up, tc
from harness import PATIENCE_S, SIP_S, Argusd, Bench, Record, Sim, wait_for
from rules import assert_only, assert_reached, assert_still_between, assert_stops_in_time, cruise
from worlds import hall

GOAL_MM = 1400
CLOCKS_S = 0.3


@pytest.fixture
def bus() -> Iterator[str]:
    """A bus of the test's own."""
    with interface("vdriving") as name:
        yield name


def drive(bench: Bench, bus: str) -> tuple[Sim, Argusd]:
    """A robot at full speed."""
    sim = bench.sim(bench.world(**hall()), link=["--can", bus])
    argusd = bench.argusd("--goal", f"{GOAL_MM},0", link=f"can:{bus}")
    cruise(sim, 100)
    return sim, argusd


def just_now_s(sim: Sim) -> float:
    """Robot time, at most a SIP late; unlike a wall clock it stands still while a busy host does."""
    return sim.t_s + SIP_S


def assert_goes_on(sim: Sim, argusd: Argusd, rest: Record) -> None:
    """It drives on after a health check, not before, and arrives."""
    argusd.wait("GOAL_REACHED")
    assert argusd.wait_exit() == 0
    assert_reached(sim, GOAL_MM)
    assert_only(argusd)
    # The two clocks are joined at the end, since the emulator's may have stood still before.
    ended_t = argusd.named("SESSION_CLOSED")[-1]["t"]
    ended_s = [record["t_s"] for record in sim.of("session") if record["state"] == "closed"][-1]
    trouble_t = argusd.named("LINK_LOST", "LINK_STALLED")[0]["t"]
    check_t = next(event["t"] for event in argusd.named("HEALTH_CHECK") if event["t"] > trouble_t)
    assert_still_between(sim, rest["t_s"], ended_s - (ended_t - check_t) - CLOCKS_S)


def test_interface_down_and_up_in_motion(bench: Bench, bus: str) -> None:
    sim, argusd = drive(bench, bus)
    set_up(bus, False)
    down_s = just_now_s(sim)
    rest = assert_stops_in_time(sim, down_s)
    argusd.wait("LINK_LOST")
    sim.wait("a while", lambda s: s["t_s"] > rest["t_s"] + 1)
    ip("link", "set", bus, "up")
    argusd.wait("LINK_UP", after_t=argusd.named("LINK_LOST")[0]["t"])
    assert_goes_on(sim, argusd, rest)


def test_interface_deleted_and_made_again_in_motion(bench: Bench, bus: str) -> None:
    sim, argusd = drive(bench, bus)
    set_up(bus, False)
    down_s = just_now_s(sim)
    ip("link", "del", bus)
    rest = assert_stops_in_time(sim, down_s)
    argusd.wait("LINK_LOST")
    ip("link", "add", bus, "type", "vcan")
    ip("link", "set", bus, "up")
    assert_goes_on(sim, argusd, rest)


def test_queue_full_for_a_moment_in_motion(bench: Bench, bus: str) -> None:
    sim, argusd = drive(bench, bus)
    tc("qdisc", "add", "dev", bus, "root", "bfifo", "limit", "1")
    time.sleep(0.8)
    tc("qdisc", "del", "dev", bus, "root")
    wait_for("it is counted", lambda: argusd.status["can"]["no_buffers"], PATIENCE_S)
    argusd.wait("GOAL_REACHED")
    assert len(argusd.named("SESSION_OPEN")) == 1
    assert argusd.wait_exit() == 0
    assert_reached(sim, GOAL_MM)


FLOOD = ("-g", "0.5", "-I", "001", "-L", "8", "-i")
HOST_SIDE, ROBOT_SIDE = "vflooda", "vfloodr"


@pytest.fixture
def wire() -> Iterator[None]:
    """Two interfaces with a wire between, which has what a vcan lacks: 31 kbit/s, and the lowest id first."""
    ip("link", "add", HOST_SIDE, "type", "vxcan", "peer", "name", ROBOT_SIDE)
    try:
        for side in (HOST_SIDE, ROBOT_SIDE):
            ip("link", "set", side, "txqueuelen", "200", "up")
            # A frame is 16 bytes here and stands for some 128 bits on a bus.
            root = ("qdisc", "add", "dev", side, "root", "handle", "1:")
            tc(*root, "tbf", "rate", "32kbit", "burst", "160", "limit", "1600")
            lanes = ("qdisc", "add", "dev", side, "parent", "1:1", "handle", "2:")
            tc(*lanes, "prio", "bands", "2", "priomap", *(["1"] * 16))
            first = ("filter", "add", "dev", side, "parent", "2:")
            tc(*first, "basic", "match", "canid(sff 0x001)", "flowid", "2:1")
        yield
    finally:
        ip("link", "del", HOST_SIDE)


def test_flooded_by_a_talker_of_higher_priority(bench: Bench, wire: None) -> None:
    """Id 1 takes the whole bus: the robot stands; when the flood ends it goes on."""
    sim = bench.sim(bench.world(**hall()), link=["--can", ROBOT_SIDE])
    argusd = bench.argusd("--goal", f"{GOAL_MM},0", link=f"can:{HOST_SIDE}")
    cruise(sim, 100)
    with (
        running("cangen", HOST_SIDE, *FLOOD),
        running("cangen", ROBOT_SIDE, *FLOOD),
    ):
        flooded_s = just_now_s(sim)
        rest = assert_stops_in_time(sim, flooded_s)
        sim.wait("a while", lambda s: s["t_s"] > rest["t_s"] + 1)
        assert argusd.process.poll() is None
    assert_goes_on(sim, argusd, rest)
