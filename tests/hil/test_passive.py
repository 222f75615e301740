# SPDX-License-Identifier: MIT
"""Rule: argusd starts passive unless TCP leads to this machine, says why, diagnoses, and moves nothing."""

from __future__ import annotations

import socket

import pytest
from harness import Bench, way_mm
from rules import OFF, assert_only, name
from worlds import hall

MOTORS = 1


def test_serial_is_passive_unless_told(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()), "off:3@5s")
    tap = bench.tap()
    course = bench.path / "course.csv"
    course.write_text("1000,0\n")
    argusd = bench.argusd("--course", str(course), link=f"serial:{tap.address}@9600", active=False)
    argusd.wait("HEALTH_CHECK")
    argusd.wait("SONAR_DISABLED", name=name(3), value=OFF)
    argusd.wait("PLAN")
    sim.wait("time to move, if it would", lambda s: s["t_s"] > 10)
    assert any("passive" in line and "--active" in line for line in argusd.errors), argusd.errors
    assert_only(argusd, (3, OFF))
    states = sim.of("state")
    assert way_mm(states[0], states[-1]) == 0
    assert all(s["v_mm_s"] == 0 and s["w_deg_s"] == 0 for s in states)
    assert not any(e["flags"] & MOTORS for e in argusd.named("STATUS") if "flags" in e)
    motions = [h for h in tap.commands() if h.name in ("MOVE", "HEAD", "DHEAD", "ROTATE", "VEL2", "E_STOP")]
    motions += [h for h in tap.commands() if h.name in ("VEL", "RVEL", "ENABLE") and h.value != 0]
    assert not motions, [h.name for h in motions]


def free_port() -> int:
    """A TCP port that nobody listens on."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return int(listener.getsockname()[1])


@pytest.mark.parametrize(("host", "drives"), [("127.0.0.1", True), ("localhost", True), ("127.1", False)])
def test_tcp_drives_at_once_to_this_machine_only(bench: Bench, host: str, drives: bool) -> None:
    """127.1 stands for a host whose name argusd does not know for this machine, although it leads there."""
    port = free_port()
    sim = bench.sim(bench.world(**hall()), link=["--tcp", str(port)])
    argusd = bench.argusd("--goal", "300,0", "--wait", "60", link=f"tcp:{host}:{port}", active=False)
    argusd.wait("HEALTH_CHECK")
    if drives:
        argusd.wait("GOAL_REACHED")
        assert argusd.wait_exit() == 0
    else:
        sim.wait("time to move, if it would", lambda s: s["t_s"] > 10)
    assert any("give --active" in line for line in argusd.errors) is not drives, argusd.errors
    states = sim.of("state")
    assert (way_mm(states[0], states[-1]) > 0) is drives
