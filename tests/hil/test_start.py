# SPDX-License-Identifier: MIT
"""Rule (S6): argusd may start before its robot; it keeps trying, then checks every sonar before it moves."""

from __future__ import annotations

import os
import pty
import socket
import time
import tty

import pytest
from harness import BAUD, Argusd, Bench, Sim, run_argusd, turning_away
from rules import assert_reached, assert_still_between
from worlds import hall


def free_port() -> int:
    """A TCP port that nobody listens on."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return int(listener.getsockname()[1])


def assert_waits(argusd: Argusd, seconds: float) -> None:
    """It is still there after a while, and has opened no session."""
    time.sleep(seconds)
    assert argusd.process.poll() is None, f"argusd gave up: {argusd.errors}"
    assert not argusd.named("SESSION_OPEN")


def assert_checked_before_it_drives(sim: Sim, argusd: Argusd) -> None:
    assert argusd.wait("SESSION_OPEN")
    check = argusd.wait("HEALTH_CHECK")
    argusd.wait("GOAL_REACHED")
    assert_still_between(sim, 0.0, sim.robot_time(argusd.unix(check)))
    assert argusd.wait_exit() == 0
    assert_reached(sim, 300)


@pytest.mark.parametrize("kind", ["serial", "tcp"])
def test_the_emulator_may_come_later(bench: Bench, kind: str) -> None:
    port = free_port()
    argusd = bench.argusd(
        "--goal", "300,0", "--wait", "60", link=f"tcp:127.0.0.1:{port}" if kind == "tcp" else None
    )
    assert_waits(argusd, 2.0)
    sim = bench.sim(bench.world(**hall()), link=["--tcp", str(port)] if kind == "tcp" else None)
    assert_checked_before_it_drives(sim, argusd)


def test_a_missing_port_without_wait_is_exit_3_with_what_to_do(bench: Bench) -> None:
    done = run_argusd("--link", f"serial:{bench.port}@{BAUD}", "--json", "--active")
    assert done.returncode == 3
    (line,) = done.stderr.splitlines()
    assert str(bench.port) in line
    assert "no such" in line.lower() or "not there" in line.lower() or "does not exist" in line.lower(), line


def test_a_silent_port_is_said_and_tried_until_the_robot_wakes(bench: Bench) -> None:
    """The port is there, but mute, as with a robot switched off; then its name leads to an emulator."""
    master, slave = pty.openpty()
    tty.setraw(slave)
    bench.port.symlink_to(os.ttyname(slave))
    argusd = bench.argusd("--goal", "300,0", "--wait", "60")
    first = argusd.wait("SESSION_NO_ANSWER")
    later = argusd.wait("SESSION_NO_ANSWER", after_t=first["t"] + 0.001)
    assert later["value"] > first["value"]
    os.close(slave)
    os.close(master)
    sim = bench.sim(bench.world(**hall()))
    argusd.wait("LINK_LOST")
    assert_checked_before_it_drives(sim, argusd)


@pytest.mark.parametrize("way", ["closes", "speaks", "resets"])
def test_a_server_that_turns_us_away_is_exit_4_with_its_words(way: str) -> None:
    """However it does so: ser2net says a word when another client has the robot."""
    with turning_away(way) as (port, _):
        done = run_argusd("--link", f"tcp:127.0.0.1:{port}", "--json", "--wait", "3")
    assert done.returncode == 4, done.stderr
    first, *_, last = (line for line in done.stderr.splitlines() if "accepts and closes" in line)
    for line in (first, last):
        assert "another client may be using the robot" in line
        assert ("saying 'Port already in use'" in line) == (way == "speaks")


def test_no_robot_at_all_is_exit_4_with_what_to_do(bench: Bench) -> None:
    master, slave = pty.openpty()
    tty.setraw(slave)
    try:
        done = run_argusd("--link", f"serial:{os.ttyname(slave)}@{BAUD}", "--json", "--active", "--wait", "2")
    finally:
        os.close(slave)
        os.close(master)
    assert done.returncode == 4
    assert "no robot answered" in done.stderr
    assert "nothing was received" in done.stderr
