# SPDX-License-Identifier: MIT
"""Rule: after a link comes back, another robot behind it is not driven, and a link that stays away says why, once."""

from __future__ import annotations

import itertools
import signal
import time

import pytest
from harness import BAUD, PATIENCE_S, Argusd, Bench, is_translating, turning_away, wait_for
from rules import cruise
from worlds import hall

GOAL_MM = 3000


def told(argusd: Argusd, part: str) -> list[str]:
    """Lines on standard error so far that hold a text."""
    return [line for line in argusd.errors if part in line]


@pytest.mark.parametrize(
    ("other", "part"),
    [(("--name", "P3DX_0002"), 1), (("--subclass", "p3dx"), 3)],
    ids=["name", "subclass"],
)
def test_another_robot_behind_the_same_name_is_not_driven(
    bench: Bench, other: tuple[str, str], part: int
) -> None:
    world = bench.world(**hall())
    sim = bench.sim(world)
    argusd = bench.argusd("--goal", f"{GOAL_MM},0")
    cruise(sim)
    sim.kill()
    lost = argusd.wait("LINK_LOST")
    again = bench.sim(world, extra=other)
    event = argusd.wait("OTHER_ROBOT", after=lost)
    assert event["value"] == part
    argusd.wait("HEALTH_CHECK", after=event)
    until = again.t_s + 3.0
    again.wait("three seconds pass", lambda s: s["t_s"] > until)
    assert not any(is_translating(state) for state in again.of("state"))
    assert argusd.status["flags"] & 1 == 0, "the motors are on"
    assert len(argusd.named("OTHER_ROBOT")) == 1
    assert argusd.status["active"] is False
    assert argusd.status["paused"] is True
    assert not argusd.named("GOAL_REACHED", "MISSION_FAILED")
    assert len(told(argusd, "another robot is at the link now")) == 1
    argusd.signal(signal.SIGTERM)
    assert argusd.wait_exit() == 0


@pytest.mark.parametrize("way", ["speaks", "resets"])
def test_a_port_that_another_client_has_taken_is_said_once_and_asked_less_often(
    bench: Bench, way: str
) -> None:
    sim = bench.sim(bench.world(**hall()), link=["--tcp", "0"])
    argusd = bench.argusd("--passive", link=f"tcp:{sim.address}", active=False)
    argusd.wait("SESSION_OPEN")
    sim.kill()
    with turning_away(way, int(sim.address.rpartition(":")[2])) as (_, taken):
        argusd.wait("LINK_LOST")
        time.sleep(6.0)
        argusd.signal(signal.SIGTERM)
        assert argusd.wait_exit() == 6
    (line,) = told(argusd, "accepts and closes")
    assert ("saying 'Port already in use'" in line) == (way == "speaks")
    pauses = [later - earlier for earlier, later in itertools.pairwise(taken)]
    assert len(taken) < 12, pauses
    assert max(pauses) > 1.5, pauses


def test_an_adapter_with_a_new_number_is_said_once(bench: Bench) -> None:
    sim = bench.sim(bench.world(**hall()))
    first, second = (bench.path / f"ttyUSB{number}" for number in (0, 1))
    tap = bench.tap()
    first.symlink_to(tap.address)
    argusd = bench.argusd(link=f"serial:{first}@{BAUD}", active=False)
    argusd.wait("SESSION_OPEN")
    first.unlink()
    bench.taps.remove(tap)
    tap.close()
    lost = argusd.wait("LINK_LOST")
    tap = bench.tap()
    second.symlink_to(tap.address)
    time.sleep(6.0)
    (line,) = told(argusd, "no such file")
    assert str(first) in line
    assert str(second) in line
    assert "by-id" in line
    second.rename(first)
    argusd.wait("SESSION_OPEN", after=lost)
    wait_for("the link is said to be open again", lambda: told(argusd, "open again"), PATIENCE_S)
    assert len(told(argusd, "open again")) == 1
    assert not argusd.named("OTHER_ROBOT")
    argusd.signal(signal.SIGTERM)
    assert argusd.wait_exit() == 0
    sim.assert_no_collision()


def test_an_adapter_that_comes_back_later_under_another_name_is_said(bench: Bench) -> None:
    """What stands beside the reason is news, too, and is said once."""
    bench.sim(bench.world(**hall()))
    first, second = (bench.path / f"ttyUSB{number}" for number in (0, 1))
    tap = bench.tap()
    first.symlink_to(tap.address)
    argusd = bench.argusd(link=f"serial:{first}@{BAUD}", active=False)
    argusd.wait("SESSION_OPEN")
    first.unlink()
    bench.taps.remove(tap)
    tap.close()
    argusd.wait("LINK_LOST")
    wait_for("the file is said to be gone", lambda: told(argusd, "no such file"), PATIENCE_S)
    assert not told(argusd, str(second))
    second.symlink_to(bench.tap().address)
    wait_for("the other one is named", lambda: told(argusd, str(second)), PATIENCE_S)
    time.sleep(5.0)
    assert len(told(argusd, "no such file")) == 2
    argusd.signal(signal.SIGTERM)
    argusd.wait_exit()
