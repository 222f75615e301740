# SPDX-License-Identifier: MIT
"""Rule: what a callback raises, rclpy's own for /clock too, ends no node: it is reported once, counted, and the node
goes on."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from argus_ros.argus_node import ArgusNode
from argus_ros.base import spin
from argus_ros.guard_node import RangeGuard
from builtin_interfaces.msg import Time
from diagnostic_msgs.msg import DiagnosticArray
from nodes import Bench
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rosgraph_msgs.msg import Clock
from test_programs import running

NODES = {"argus-ros": "argus", "argus-range-guard": "range_guard"}
ODD_CLOCKS = {
    "before 1970": Time(sec=-1),
    "long before": Time(sec=-(1 << 31), nanosec=1),
    "more than a second of ns": Time(sec=5, nanosec=(1 << 32) - 1),
}


@pytest.mark.parametrize("odd", sorted(ODD_CLOCKS))
@pytest.mark.parametrize("program", sorted(NODES))
def test_an_odd_clock_ends_no_node(program: str, odd: str) -> None:
    bench = Bench()
    bench.listen(DiagnosticArray, "/diagnostics")
    clock = bench.listener.create_publisher(Clock, "/clock", 10)

    def told(text: str) -> bool:
        clock.publish(Clock(clock=ODD_CLOCKS[odd] if text else Time(sec=7)))
        bench.executor.spin_once(timeout_sec=0.2)
        statuses = [s for _, m in bench.heard for s in m.status if s.name == f"{NODES[program]}: topics"]
        if not text:
            return bool(statuses)
        return any(text in v.key for s in statuses for v in s.values) or ODD_CLOCKS[odd].sec >= 0

    with running([program, "--ros-args", "-p", "use_sim_time:=true"]):
        assert bench.until(lambda: told(""), 60)
        assert bench.until(lambda: told("must not be negative"), 60)
        bench.take()
        assert bench.until(lambda: told(""), 60), "it goes on"
    bench.close()


@pytest.fixture
def node(request: pytest.FixtureRequest) -> Iterator[Any]:
    made = request.param()
    yield made
    made.destroy_node()


class Raising:
    """Stands for an executor: raises what is given, one after the other, then the context ends."""

    def __init__(self, *errors: BaseException) -> None:
        self.errors = list(errors)

    def spin(self) -> None:
        if self.errors:
            raise self.errors.pop(0)


@pytest.mark.parametrize("node", [ArgusNode, RangeGuard], indirect=True)
def test_each_kind_is_reported_once_and_all_are_counted(node: Any) -> None:
    spin(node, Raising(*[ValueError("odd")] * 40, KeyError("a"), *[OSError(f"n{k}") for k in range(100)]))
    status = node.topics_status()
    found = {value.key: value.value for value in status.values}
    assert found["ValueError: odd"] == "not handled, 40 times"
    assert len(found) == 16, "bounded"
    assert status.level == b"\x01"


@pytest.mark.parametrize("node", [ArgusNode, RangeGuard], indirect=True)
@pytest.mark.parametrize("end", [KeyboardInterrupt, ExternalShutdownException])
def test_what_ends_a_program_ends_it(node: Any, end: type[BaseException]) -> None:
    executor = Raising(ValueError(), end(), ValueError())
    with pytest.raises(end):
        spin(node, executor)
    assert len(executor.errors) == 1


def test_an_executor_goes_on_after_a_callback_that_raises() -> None:
    guard = RangeGuard()
    executor = SingleThreadedExecutor()
    executor.add_node(guard)
    calls: list[int] = []

    def tick() -> None:
        calls.append(1)
        if len(calls) < 5:
            raise ValueError("odd")
        raise KeyboardInterrupt

    guard.create_timer(0.01, tick)
    with pytest.raises(KeyboardInterrupt):
        spin(guard, executor)
    assert len(calls) == 5
    guard.destroy_node()
