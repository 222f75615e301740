# SPDX-License-Identifier: MIT
"""Drives about by the sonars that a ROS 1 driver publishes; runs on ROS's own Python, beside p2os or rosaria."""

from __future__ import annotations

import importlib
import math
import sys
import time
from collections.abc import Callable, Sequence
from typing import Any, Final

FRONT: Final = (2, 3, 4, 5)
NEAR_M: Final = 0.6
FREE_M: Final = 0.8
SPEED_M_S: Final = 0.3
TURN_RAD_S: Final = 0.6
RATE_HZ: Final = 10
FRESH_S: Final = 1.0


class Wander:
    """Ahead until something is near in front; then a turn to the freer side until nothing is."""

    def __init__(self) -> None:
        self.ranges: Sequence[float] = ()
        self.heard_s = -math.inf
        self._turn = 0.0

    def hear(self, ranges: Sequence[float]) -> None:
        """Take what the ring reads."""
        self.ranges, self.heard_s = ranges, time.monotonic()

    def speeds(self) -> tuple[float, float]:
        """What to order now: m/s ahead, rad/s to the left. Without readings it stands."""
        if time.monotonic() - self.heard_s > FRESH_S or len(self.ranges) < 8:
            return 0.0, 0.0
        nearest = min(self.ranges[k] for k in FRONT)
        if self._turn and nearest > FREE_M:
            self._turn = 0.0
        elif not self._turn and nearest < NEAR_M:
            self._turn = TURN_RAD_S if sum(self.ranges[:4]) > sum(self.ranges[4:8]) else -TURN_RAD_S
        return (0.0, self._turn) if self._turn else (SPEED_M_S, 0.0)


def of_p2os(ros: Any, wander: Wander) -> tuple[str, Callable[[], None]]:
    """Listen to p2os; return its topic of orders, and what switches its motors on."""
    p2os = importlib.import_module("p2os_msgs.msg")
    ros.Subscriber("sonar", p2os.SonarArray, lambda said: wander.hear(said.ranges))
    motors = ros.Publisher("cmd_motor_state", p2os.MotorState, queue_size=1, latch=True)
    return "cmd_vel", lambda: motors.publish(p2os.MotorState(state=1))


def of_rosaria(ros: Any, wander: Wander) -> tuple[str, Callable[[], None]]:
    """Listen to rosaria, which gives points around the robot and switches its motors on itself."""
    sensors = importlib.import_module("sensor_msgs.msg")
    ros.Subscriber(
        "RosAria/sonar",
        sensors.PointCloud,
        lambda said: wander.hear([math.hypot(point.x, point.y) for point in said.points]),
    )
    return "RosAria/cmd_vel", lambda: None


def main(driver: str, seconds: float) -> None:
    """Drive for so long, then stand."""
    ros = importlib.import_module("rospy")
    twist = importlib.import_module("geometry_msgs.msg").Twist
    wander = Wander()
    ros.init_node("wander", disable_signals=True)
    topic, motors_on = {"p2os": of_p2os, "rosaria": of_rosaria}[driver](ros, wander)
    orders = ros.Publisher(topic, twist, queue_size=1)
    motors_on()
    until = time.monotonic() + seconds
    while time.monotonic() < until and not ros.is_shutdown():
        order = twist()
        order.linear.x, order.angular.z = wander.speeds()
        orders.publish(order)
        time.sleep(1 / RATE_HZ)
    for _ in range(RATE_HZ):
        orders.publish(twist())
        time.sleep(1 / RATE_HZ)


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]))
