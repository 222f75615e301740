# SPDX-License-Identifier: MIT
"""Rule (S6, S8): argusd may be started before its robot; it keeps trying, says so, and checks all sonars before it moves."""

from __future__ import annotations

import socket

from harness import Bench, is_translating
from worlds import hall


def free_port() -> int:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return int(listener.getsockname()[1])


def test_cold_start_over_tcp_with_the_emulator_later(bench: Bench) -> None:
    port = free_port()
    argusd = bench.argusd("--goal", "300,0", "--wait", "60", link=f"tcp:127.0.0.1:{port}")
    with __import__("contextlib").suppress(Exception):
        argusd.wait("STATUS", timeout_s=2)
    assert argusd.process.poll() is None
    sim = bench.sim(bench.world(**hall()), link=["--tcp", str(port)])
    argusd.wait("SESSION_OPEN")
    check = argusd.wait("HEALTH_CHECK")
    argusd.wait("GOAL_REACHED")
    checked_s = sim.robot_time(argusd.unix(check))
    assert not [s for s in sim.of("state") if is_translating(s) and s["t_s"] < checked_s]
    assert argusd.wait_exit() == 0
