# SPDX-License-Identifier: MIT
"""Rule: the robot does what cmd_vel says, no faster than the bounds, and stands when nobody says it any more."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from argus_ros.argus_node import ArgusNode
from geometry_msgs.msg import Twist
from nodes import PATIENCE_S, Bench
from rclpy.parameter import Parameter
from robots import emulated, free_port, minded

from hil_sim.arcos import FLAG

MOVING_MM_S = 20


class Driven:
    """An emulated robot, the node on its port, and somebody who sends cmd_vel."""

    def __init__(self, folder: Path, *simulated: str, guard_port: int | None = None, **given: Any) -> None:
        self.sim, address = emulated(folder, *(simulated or ("--world", "hall")))
        self.argusd, place = None, f"unix:{folder}/none.sock"
        if guard_port is not None:
            guard = f"127.0.0.1:{guard_port}"
            self.argusd, place = minded(folder, address, "--guard", f"tcp:{guard}")
            address = guard
        self.node = ArgusNode()
        values = {"control": place, "guard": address, **given}
        self.node.set_parameters([Parameter(key, value=value) for key, value in values.items()])
        self.node.start()
        self.bench = Bench(self.node)
        self.publisher = self.bench.listener.create_publisher(Twist, "cmd_vel", 1)
        assert self.bench.until(lambda: bool(self.publisher.get_subscription_count()))
        assert self.bench.until(lambda: self.wheels.connected and self.wheels.sips > 0)

    @property
    def wheels(self) -> Any:
        assert self.node._wheels is not None
        return self.node._wheels

    def drive(self, speed: float, turn: float, seconds: float) -> list[dict[str, Any]]:
        """Order the same for a while by the robot's clock; return its true states meanwhile."""
        begin = self.sim.t_s
        self.order_until(lambda: self.sim.t_s > begin + seconds, speed, turn)
        return self.sim.of("state", begin)

    def drive_until_moving(self) -> None:
        """Order 0.2 m/s until it moves: on a busy host an order may be late, and it stands meanwhile."""
        self.order_until(lambda: bool(self.sim.now["v_mm_s"] > MOVING_MM_S), 0.2, 0.0)

    def order_until(self, done: Callable[[], bool], speed: float, turn: float) -> None:
        """Order the same ten times a second until something holds."""
        twist = Twist()
        twist.linear.x, twist.angular.z = speed, turn
        end = time.monotonic() + PATIENCE_S
        while not done():
            assert time.monotonic() < end, f"not within {PATIENCE_S:g} s"
            self.publisher.publish(twist)
            self.spin(0.1)

    def spin(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0:
            self.bench.executor.spin_once(timeout_sec=left)

    def close(self) -> None:
        self.bench.close()
        self.node.destroy_node()
        if self.argusd is not None:
            self.argusd.end()
        self.sim.end()


@pytest.fixture
def driven(tmp_path: Path) -> Iterator[Any]:
    made: list[Driven] = []

    def make(*simulated: str, **given: Any) -> Driven:
        made.append(Driven(tmp_path, *simulated, **given))
        return made[-1]

    yield make
    for one in made:
        one.close()


def test_the_robot_drives_and_stands_when_nobody_says_anything(driven: Any) -> None:
    robot = driven(cmd_vel_timeout_s=0.4)
    states = robot.drive(0.2, 0.0, 3)
    assert max(state["v_mm_s"] for state in states) == pytest.approx(200, abs=5)
    assert robot.bench.until(lambda: bool(robot.sim.now["v_mm_s"] <= MOVING_MM_S))
    assert not robot.node._wheels._said or robot.wheels._said == (0, 0)
    stopped = robot.sim.wait_rest()
    began = next(s["t_s"] for s in reversed(robot.sim.of("state")) if s["v_mm_s"] > 150)
    # 0.4 s of patience, then 200 mm/s braked at 300 mm/s^2.
    assert stopped["t_s"] - began < 4


def test_speeds_are_bounded(driven: Any) -> None:
    robot = driven(max_speed_m_s=0.3, max_turn_rad_s=0.5)
    states = robot.drive(9.0, 0.0, 3)
    assert 250 < max(state["v_mm_s"] for state in states) < 310
    robot.drive(0.0, 0.0, 2)
    states = robot.drive(0.0, -9.0, 2)
    assert -32 < min(state["w_deg_s"] for state in states) < -20


def test_no_number_stops_it(driven: Any) -> None:
    robot = driven()
    robot.drive(0.2, 0.0, 1.5)
    robot.drive(math.nan, 0.0, 2)
    assert robot.wheels._said == (0, 0)
    robot.sim.wait_rest()


def test_a_node_that_is_deactivated_or_ends_lets_it_stand(driven: Any) -> None:
    robot = driven()
    robot.drive(0.2, 0.0, 1.5)
    robot.node.trigger_deactivate()
    robot.drive(0.2, 0.0, 1.5)
    robot.sim.wait_rest()
    robot.node.trigger_activate()
    robot.drive_until_moving()
    robot.node.trigger_deactivate()
    robot.node.trigger_cleanup()
    robot.sim.wait_rest()


def test_motors_are_left_alone_before_the_first_order(driven: Any) -> None:
    robot = driven()
    robot.spin(1.0)
    assert robot.wheels._said is None
    assert not robot.wheels.last.flags & FLAG["MOTORS"]
    robot.drive(0.1, 0.0, 1.0)
    assert robot.wheels.last.flags & FLAG["MOTORS"]


def test_through_the_guard_a_wall_is_not_run_into_with_a_sonar_dead(driven: Any) -> None:
    # Whoever sends cmd_vel goes on ordering 0.3 m/s; what becomes of that without the guard is shown below.
    robot = driven("--world", "box-ahead", "--fault", "off:3@1s", guard_port=free_port())
    robot.drive(0.3, 0.0, 12)
    robot.sim.assert_no_collision()
    assert robot.sim.now["x_mm"] > 100
    robot.sim.wait_rest()


def test_without_the_guard_it_is(driven: Any) -> None:
    robot = driven("--world", "box-ahead", "--fault", "off:3@1s")
    robot.drive(0.3, 0.0, 12)
    assert robot.sim.of("collision")
