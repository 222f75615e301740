# SPDX-License-Identifier: MIT
"""Rule: a state that must end, ends: after shutdown, cleanup, a deactivation or an error the robot stands, and the node
takes nothing and publishes nothing."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from argus_ros.guard_node import RangeGuard
from argus_tools.rings.motion import Motion
from diagnostic_msgs.msg import DiagnosticArray
from drives import Told
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState, GetState
from nav_msgs.msg import Odometry
from nodes import Bench, Driver
from sensor_msgs.msg import PointCloud2, Range
from test_cmd_vel import MOVING_MM_S, Driven

ENDS = {
    "shutdown": Transition.TRANSITION_ACTIVE_SHUTDOWN,
    "deactivate": Transition.TRANSITION_DEACTIVATE,
}
FINALIZED, UNCONFIGURED = 4, 1


@pytest.fixture
def driven(tmp_path: Path) -> Iterator[Any]:
    made: list[Driven] = []

    def make(**given: Any) -> Driven:
        made.append(Driven(tmp_path, **given))
        return made[-1]

    yield make
    for one in made:
        one.close()


def ask(bench: Bench, kind: Any, name: str, request: Any) -> Any:
    """Call a service; a client that DDS does not match with it on a busy host is made anew."""
    client = bench.listener.create_client(kind, name)
    for _ in range(6):
        if bench.until(client.service_is_ready, 10):
            break
        bench.listener.destroy_client(client)
        client = bench.listener.create_client(kind, name)
    assert client.service_is_ready(), f"{name}: no server was matched in a minute"
    future = client.call_async(request)
    assert bench.until(future.done)
    return future.result()


def change(bench: Bench, node: str, transition: int) -> None:
    request = ChangeState.Request(transition=Transition(id=transition))
    assert ask(bench, ChangeState, f"{node}/change_state", request).success


def state(bench: Bench, node: str) -> int:
    return int(ask(bench, GetState, f"{node}/get_state", GetState.Request()).current_state.id)


def assert_stands_for_good(robot: Driven) -> None:
    """It stands, and whoever goes on sending cmd_vel does not move it."""
    robot.drive(0.2, 0.0, 1.5)
    robot.sim.wait_rest()
    states = robot.drive(0.2, 0.0, 1.5)
    assert max(abs(s["v_mm_s"]) for s in states) <= MOVING_MM_S


@pytest.mark.parametrize("end", sorted(ENDS))
def test_a_transition_of_a_driving_robot_lets_it_stand(driven: Any, end: str) -> None:
    robot = driven()
    robot.drive(0.2, 0.0, 1.5)
    robot.drive_until_moving()
    change(robot.bench, "argus", ENDS[end])
    if end == "shutdown":
        assert state(robot.bench, "argus") == FINALIZED
        assert robot.bench.until(lambda: robot.publisher.get_subscription_count() == 0)
        assert robot.node._wheels is None
    assert_stands_for_good(robot)


def test_cleanup_and_shutdown_of_a_node_at_rest_end_all_parts(driven: Any) -> None:
    robot = driven()
    robot.drive(0.2, 0.0, 1.5)
    change(robot.bench, "argus", Transition.TRANSITION_DEACTIVATE)
    change(robot.bench, "argus", Transition.TRANSITION_CLEANUP)
    assert state(robot.bench, "argus") == UNCONFIGURED
    change(robot.bench, "argus", Transition.TRANSITION_UNCONFIGURED_SHUTDOWN)
    assert state(robot.bench, "argus") == FINALIZED
    assert_stands_for_good(robot)
    assert not robot.node._parts


def test_a_transition_that_fails_lets_it_stand(driven: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    robot = driven()
    robot.drive(0.2, 0.0, 1.5)

    def broken() -> None:
        raise RuntimeError("broken")

    rest, times = robot.node._rest, []

    def once() -> None:
        times.append(time.monotonic())
        (broken if len(times) == 1 else rest)()

    monkeypatch.setattr(robot.node, "_rest", once)
    robot.node.trigger_deactivate()
    assert state(robot.bench, "argus") == UNCONFIGURED
    assert robot.node._wheels is None
    assert_stands_for_good(robot)


def test_motors_that_nobody_used_are_left_alone_by_an_end(driven: Any) -> None:
    robot = driven()
    wheels = robot.wheels
    robot.node.trigger_deactivate()
    robot.spin(0.5)
    assert wheels._said is None


def packet(t_s: float) -> Told:
    return Told(
        t_s, Motion(), tuple((k, 1.0) for k in (2, 3, 4))
    )  # few: a busy host handles some tens a second


@pytest.mark.parametrize("end", ["shutdown", "deactivate", "cleanup", "error"])
def test_the_guard_publishes_nothing_behind_its_end(end: str, monkeypatch: pytest.MonkeyPatch) -> None:
    driver, guard = Driver(), RangeGuard()
    guard.start()
    bench = Bench(driver, guard)
    bench.listen(Range, "sonar/range_3/guarded")
    bench.listen(PointCloud2, "sonar/cloud_guarded")
    bench.listen(DiagnosticArray, "/diagnostics")
    assert bench.until(lambda: bool(driver.ranges[3].get_subscription_count()))
    told_s = [0.0]

    def tell() -> bool:
        if time.monotonic() - told_s[0] > 0.2:
            told_s[0] = time.monotonic()
            driver.tell(packet(told_s[0]))
        bench.executor.spin_once(timeout_sec=0.01)
        return len({topic for topic, _ in bench.heard}) == 3

    assert bench.until(tell)
    if end == "error":
        monkeypatch.setattr(guard, "_rest", lambda: 1 / 0)  # in the transition, and in its error again
    getattr(guard, f"trigger_{'deactivate' if end in ('cleanup', 'error') else end}")()
    if end == "cleanup":
        guard.trigger_cleanup()
    while not bench.until(lambda: False, 1.0) and bench.take():
        pass  # what it has published before is still on its way on a busy host
    bench.until(lambda: tell() and False, 1.5)
    assert bench.take() == []
    if end != "deactivate":
        assert guard._parts == []
        assert bench.until(lambda: driver.ranges[3].get_subscription_count() == 0)
    bench.close()
    driver.destroy_node()
    guard.destroy_node()


@pytest.mark.parametrize("broken", ["_rest", "_close", "discard"])
def test_a_part_whose_end_fails_keeps_no_other_from_its_end(
    broken: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    guard = RangeGuard()
    guard.trigger_configure()
    guard.trigger_activate()
    ended = []
    for name in ("_rest", "_close", "discard"):

        def step(*given: Any, name: str = name) -> None:
            ended.append(name)
            if name == broken:
                raise OSError("broken")

        monkeypatch.setattr(guard, name, step)
    count = len(guard._parts)
    guard.trigger_shutdown()
    assert ended == ["_rest", "_close", *["discard"] * count]
    assert count > 16
    assert not guard._active
    monkeypatch.undo()
    guard.destroy_node()


def test_a_node_can_be_configured_anew_behind_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    guard = RangeGuard()
    with monkeypatch.context() as patch:
        patch.setattr(guard, "_mapping", lambda: 1 / 0)
        guard.trigger_configure()
    assert "division" in guard.refusal
    assert guard._parts == []
    guard.trigger_configure()
    guard.trigger_activate()
    assert guard._active
    assert guard.create_publisher(Odometry, "pose", 1)
    guard.destroy_node()
