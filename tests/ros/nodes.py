# SPDX-License-Identifier: MIT
"""Real nodes for the tests: a driver that publishes a drive, and a listener that keeps what it hears."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

from argus_ros import messages
from argus_tools.rings.intake import Limits
from drives import GREATEST_M, LEAST_M, Told
from nav2_rules import Seat
from nav_msgs.msg import Odometry
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.time import Time
from sensor_msgs.msg import Range

from hil_sim.tables.robot import robot_table

VIEW_RAD = math.radians(30)
EPOCH_S = 1_700_000_000.0
# A guard against what hangs, not a rule: a busy host needs long until one participant finds another.
PATIENCE_S = 120.0
SEATS = {
    number: Seat(mount.x_mm / 1000, mount.y_mm / 1000, math.radians(mount.heading_deg))
    for number, mount in enumerate(robot_table().mounts)
}


def stamp(t_s: float) -> Any:
    return Time(nanoseconds=round((EPOCH_S + t_s) * 1e9)).to_msg()


class Counted:
    """A publisher that counts, so that a test knows when all of it has been heard."""

    sent = 0

    def __init__(self, publisher: Any) -> None:
        self._publish = publisher.publish
        publisher.publish = self

    def __call__(self, message: Any) -> None:
        Counted.sent += 1
        self._publish(message)


class Driver(Node):  # type: ignore[misc]
    """A driver with a topic for each sonar. `no_echo_m`: what it says where nothing is seen."""

    def __init__(self, no_echo_m: float = GREATEST_M) -> None:
        super().__init__("driver")
        self.no_echo_m = no_echo_m
        self.ranges = [self.create_publisher(Range, f"sonar/range_{k}", 10) for k in range(16)]
        self.pose = self.create_publisher(Odometry, "pose", 10)

    def tell_pose(self, told: Told) -> None:
        """Publish where the robot is."""
        self.pose.publish(messages.odometry(stamp(told.t_s), "odom", "base_link", told.motion))

    def tell(self, told: Told) -> list[tuple[int, Any]]:
        """Publish the ranges of one packet; return them."""
        at, limits = stamp(told.t_s), Limits(LEAST_M, GREATEST_M)
        said = []
        for number, range_m in told.ranges:
            value = self.no_echo_m if range_m >= GREATEST_M else range_m
            message = messages.range_message(at, f"sonar_{number}", value, limits, VIEW_RAD)
            self.ranges[number].publish(message)
            said.append((number, message))
        return said


class Bench:
    """An executor over some nodes, and what was heard on topics."""

    def __init__(self, *nodes: Any) -> None:
        self.listener = Node("listener")
        self.executor = SingleThreadedExecutor()
        for node in (*nodes, self.listener):
            self.executor.add_node(node)
        self.heard: list[tuple[str, Any]] = []

    def listen(self, kind: Any, topic: str, qos: Any = 50) -> None:
        self.listener.create_subscription(
            kind, topic, lambda message: self.heard.append((topic, message)), qos
        )

    def until(self, what: Callable[[], bool], limit_s: float = PATIENCE_S) -> bool:
        """Spin until something holds; False when it does not come to hold."""
        end = time.monotonic() + limit_s
        while time.monotonic() < end:
            if what():
                return True
            self.executor.spin_once(timeout_sec=0.02)
        return what()

    def take(self) -> list[tuple[str, Any]]:
        """What was heard since the last call."""
        heard, self.heard = self.heard, []
        return heard

    def close(self) -> None:
        self.executor.shutdown()
        self.listener.destroy_node()
