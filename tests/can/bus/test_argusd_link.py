# SPDX-License-Identifier: MIT
"""Rule: argusd counts what goes wrong on a CAN link and its session survives; what it cannot open it explains."""

from __future__ import annotations

import json
import math
import random
import subprocess
import threading
import time
from collections.abc import Iterator

import pytest
from canbus import OVERFLOW, Raw, first_frame, interface, ip
from harness import PATIENCE_S, Argusd, Bench, run_argusd, wait_for
from rawrobot import RawRobot

from hil_sim.links.can import PACKET_MAX
from hil_sim.links.can_spec import TO_HOST_ID


@pytest.fixture
def bus() -> Iterator[str]:
    """A bus of the test's own."""
    with interface("vargusd") as name:
        yield name


@pytest.fixture
def robot(bus: str) -> Iterator[RawRobot]:
    """A robot with the manners of a test."""
    result = RawRobot(bus)
    try:
        yield result
    finally:
        result.end()


def counted(argusd: Argusd) -> dict[str, int]:
    """What the link has counted so far."""
    can = argusd.status.get("can", {})
    return {key: value for key, value in can.items() if key not in ("sent", "taken", "refused") and value}


def assert_survives(argusd: Argusd, **expected: int) -> None:
    """The errors are counted, SIPs go on, and the session is the one it was."""
    wait_for(
        f"{expected}, not {counted(argusd)}", lambda: expected.items() <= counted(argusd).items(), PATIENCE_S
    )
    before = argusd.status["sips"]
    wait_for("SIPs go on", lambda: argusd.status["sips"] > before + 10, PATIENCE_S)
    assert counted(argusd) == expected
    assert len(argusd.named("SESSION_OPEN")) == 1
    assert not argusd.named("LINK_LOST")


def passive(bench: Bench, bus: str) -> Argusd:
    """An argusd whose session is open."""
    argusd = bench.argusd(link=f"can:{bus}", active=False)
    argusd.wait("SESSION_OPEN")
    wait_for("SIPs come", lambda: argusd.status.get("sips", 0) > 3, PATIENCE_S)
    return argusd


def test_wrong_sequence(bench: Bench, bus: str, robot: RawRobot) -> None:
    argusd = passive(bench, bus)
    robot.link.end.manners.wrong = 1
    assert_survives(argusd, sequence=1)


def test_lost_consecutive_frame(bench: Bench, bus: str, robot: RawRobot) -> None:
    argusd = passive(bench, bus)
    robot.link.hush_until_s = math.inf
    time.sleep(0.1)
    robot.link.end.raw.send(TO_HOST_ID, first_frame(40, b"\xfa\xfb\x25\x32\x00\x00"))
    wait_for("it is counted", lambda: counted(argusd), PATIENCE_S)
    robot.link.hush_until_s = 0.0
    assert_survives(argusd, timeout=1)


@pytest.mark.parametrize("length", [PACKET_MAX + 1, 400, 4095])
def test_message_longer_than_any_packet(bench: Bench, bus: str, robot: RawRobot, length: int) -> None:
    argusd = passive(bench, bus)
    robot.link.before = [b"\xfa\xfb\xff".ljust(length, b"\x55")]
    assert_survives(argusd, too_long=1)
    assert argusd.status["skipped_bytes"] == 0, "a part of it went on to the parser"


def test_flow_control_overflow(bench: Bench, bus: str, robot: RawRobot) -> None:
    """In the first message to the robot that takes more than a frame."""
    robot.link.end.manners.answers = [OVERFLOW]
    argusd = passive(bench, bus)
    assert_survives(argusd, overflow=1)


def test_no_flow_control(bench: Bench, bus: str, robot: RawRobot) -> None:
    robot.link.end.manners.answers = [None]
    argusd = passive(bench, bus)
    assert_survives(argusd, no_flow=1)


def test_two_talkers_on_one_id(bench: Bench, bus: str, robot: RawRobot) -> None:
    """Random frames and torn messages among those of the robot."""
    argusd = passive(bench, bus)
    rng = random.Random(3)
    second = Raw(bus, [TO_HOST_ID])
    try:
        for _ in range(200):
            second.send(TO_HOST_ID, rng.choice((first_frame(60, rng.randbytes(6)), rng.randbytes(8))))
            time.sleep(0.01)
    finally:
        second.close()
    wait_for("errors are counted", lambda: counted(argusd), PATIENCE_S)
    before = argusd.status["sips"]
    wait_for("SIPs go on", lambda: argusd.status["sips"] > before + 10, PATIENCE_S)
    assert len(argusd.named("SESSION_OPEN")) == 1


# starting ---------------------------------------------------------------------------------------------------


def said(done: subprocess.CompletedProcess[str]) -> str:
    """The one line in which a program says why it cannot start."""
    lines = done.stderr.strip().splitlines()
    assert len(lines) == 1, done.stderr
    return lines[0]


def test_missing_interface_is_named_with_the_command() -> None:
    done = run_argusd("--link", "can:vcan9", "--check")
    assert done.returncode == 3
    assert "vcan9: no such interface" in said(done)
    assert "ip link add vcan9 type vcan" in said(done)


def test_interface_that_is_down_is_named_with_the_command(bus: str) -> None:
    ip("link", "set", bus, "down")
    done = run_argusd("--link", f"can:{bus}", "--check")
    assert done.returncode == 3
    assert f"ip link set {bus} up" in said(done)


def test_an_interface_that_is_no_bus() -> None:
    done = run_argusd("--link", "can:lo", "--check")
    assert done.returncode == 3
    assert "lo: not a CAN interface" in said(done)


def test_nobody_answers(bus: str) -> None:
    done = run_argusd("--link", f"can:{bus}", "--check", "--wait", "2")
    assert done.returncode == 4


@pytest.mark.parametrize(("option", "wrong"), [("", True), (",fd", False)])
def test_a_peer_with_frames_of_the_other_format_is_named(bus: str, option: str, wrong: bool) -> None:
    """Rule: the kernel passes over such frames; argusd does not."""
    done = threading.Event()
    raw = Raw(bus, fd=True)

    def answer() -> None:
        while not done.wait(0.2):
            raw.send(TO_HOST_ID, b"\x06\xfa\xfb\x03\x00\x00\x00\xcc", fd=wrong)

    peer = threading.Thread(target=answer)
    peer.start()
    said_so = run_argusd("--link", f"can:{bus}{option}", "--check", "--wait", "3")
    driving = run_argusd("--link", f"can:{bus}{option}", "--json", "--status", "500", "--wait", "4")
    done.set()
    peer.join()
    raw.close()
    *_, last = (json.loads(line) for line in driving.stdout.splitlines())
    assert last["can"]["format"] > 0, "not only --check listens"
    assert said_so.returncode == driving.returncode == 4
    assert "CAN FD frames where this link has classic ones, or the reverse" in driving.stderr
    assert "CAN FD frames where this link has classic ones, or the reverse" in said(said_so)


@pytest.mark.parametrize("options", ["", ",fd", ",pad=none,bs=2,stmin=1", ",tx=0x100,rx=0x101"])
def test_check_with_the_options_of_both_ends(bench: Bench, bus: str, options: str) -> None:
    """What argus-sim prints is what argusd takes."""
    theirs = options.replace("tx=0x100,rx=0x101", "tx=0x101,rx=0x100")
    sim = bench.sim("lab", link=["--can", f"{bus}{theirs}"])
    spec = sim.address if "=0x1" in options else f"{bus}{options}"
    done = run_argusd("--link", f"can:{spec}", "--check")
    assert done.returncode == 0, done.stderr
    assert "P3DX_0001" in done.stdout


def test_several_robots_on_one_bus(bench: Bench, bus: str) -> None:
    sim = bench.sim("lab", link=["--can", f"{bus},robot=5"], extra=["--robots", "3"])
    assert sim.address == f"{bus},robot=5"
    daemons = [bench.argusd(link=f"can:{bus},robot={k}", active=False) for k in (5, 6, 7)]
    for k, argusd in enumerate(daemons):
        argusd.wait("SESSION_OPEN")
        wait_for("SIPs come", lambda argusd=argusd: argusd.status.get("sips", 0) > 10, PATIENCE_S)  # type: ignore[misc]
        assert argusd.status["robot"] == f"P3DX_000{k + 1}"
        assert not counted(argusd)
