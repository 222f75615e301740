# SPDX-License-Identifier: MIT
"""What a message of ROS says, judged: finite, in range, newer. It may be rclpy's, or one out of a bag."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

from argus_tools.rings.motion import Motion

MOST_RANGE_M: Final = 100.0
"""No sonar sees farther: a greater limit is one in millimetres."""
MOST_BEYOND: Final = 2.0
"""A driver may say somewhat more than its greatest range for no echo; so many times that is another unit."""
MOST_SPEED_M_S: Final = 10.0
MOST_TURN_RAD_S: Final = 20.0
MOST_PLACE_M: Final = 1e7
_UNIT_WITHIN: Final = 0.1
_NANO: Final = 1_000_000_000
ORDER_S: Final = 1.0
"""Topics of one driver are not in order to the millisecond; what is further away is another clock."""


@dataclass(frozen=True)
class Limits:
    """The least and the greatest range of a sonar, m."""

    least_m: float
    greatest_m: float

    def is_echo(self, range_m: float) -> bool:
        """Whether a reading tells of something seen."""
        return self.least_m <= range_m < self.greatest_m


class Odd(Exception):
    """A message that is discarded; the text says what is odd, without its value, so that like ones count as one."""


def _finite(what: str, *values: float) -> None:
    if not all(map(math.isfinite, values)):
        raise Odd(f"{what} is not finite")


def _bounded(what: str, most: float, unit: str, *values: float) -> None:
    _finite(what, *values)
    if any(abs(value) > most for value in values):
        raise Odd(f"{what} is beyond {most:g} {unit}")


def stamp_of(header: Any) -> float | None:
    """Return the time of a header, s; None where it has none."""
    stamp = header.stamp
    if stamp.sec < 0 or stamp.nanosec >= _NANO:
        raise Odd("stamp is no time")
    return float(stamp.sec) + float(stamp.nanosec) / _NANO if stamp.sec or stamp.nanosec else None


def speeds_of(twist: Any) -> tuple[float, float]:
    """Return speed ahead and turn of a twist: m/s, rad/s. They may be any that are finite: they are bounded later."""
    _finite("speed", twist.linear.x, twist.angular.z)
    return float(twist.linear.x), float(twist.angular.z)


def yaw_of(turned: Any) -> float:
    """Return the heading of a quaternion that turns about the vertical axis."""
    parts = (turned.x, turned.y, turned.z, turned.w)
    _finite("orientation", *parts)
    if not abs(math.hypot(*parts) - 1) <= _UNIT_WITHIN:
        raise Odd("orientation is no quaternion of length 1")
    return math.atan2(2 * (turned.w * turned.z + turned.x * turned.y), 1 - 2 * (turned.y**2 + turned.z**2))


def motion_of(message: Any) -> Motion:
    """Return where the robot is and how it moves, of a nav_msgs/Odometry."""
    place, twist = message.pose.pose.position, message.twist.twist
    _bounded("position", MOST_PLACE_M, "m", place.x, place.y)
    _bounded("speed", MOST_SPEED_M_S, "m/s", twist.linear.x)
    _bounded("turn", MOST_TURN_RAD_S, "rad/s", twist.angular.z)
    return Motion(place.x, place.y, yaw_of(message.pose.pose.orientation), twist.linear.x, twist.angular.z)


def limits_of(message: Any) -> Limits:
    """Return the limits of a sensor_msgs/Range whose reading holds; NaN is a reading (REP 117: it failed)."""
    least, greatest, reading = message.min_range, message.max_range, message.range
    _finite("min_range or max_range", least, greatest)
    if not (0 <= least <= greatest and 0 < greatest <= MOST_RANGE_M):
        raise Odd(f"min_range and max_range are no limits of 0 to {MOST_RANGE_M:g} m")
    if not 0 <= message.field_of_view <= math.tau:
        raise Odd("field_of_view is no angle of 0 to 2 pi rad")
    if math.isfinite(reading) and not 0 <= reading <= MOST_BEYOND * greatest:
        raise Odd("range is far out of its limits: is it in metres?")
    return Limits(least, greatest)


class Order:
    """Whether the stamps of one topic get newer. Farther back than ORDER_S another clock begins."""

    def __init__(self) -> None:
        self.last_s = -math.inf

    def check(self, at_s: float) -> None:
        """Take a stamp that is newer, or of another clock; Odd for any other."""
        if self.last_s - ORDER_S < at_s <= self.last_s:
            raise Odd("stamp is not newer than the last")
        self.last_s = at_s
