# SPDX-License-Identifier: MIT
"""range_guard: takes the Range topics of any driver, runs the fault manager on them, and publishes repaired ones."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Final

from argus_tools.core import setting_value
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from rclpy.qos import qos_profile_sensor_data
from rclpy.time import Time
from sensor_msgs.msg import PointCloud2, Range

from argus_ros import messages, parameters
from argus_ros.base import ArgusLifecycleNode, Refused
from argus_ros.repair import Limits, Verdict, bearings, neighbours
from argus_ros.ring import Motion, Ring

OWNER: Final = "range_guard"
_COVER_AGE_S: Final = 1.0
_COVER_PERIOD_S: Final = 0.25


class _Sonar:
    """One topic: what came last, and where the repaired readings go."""

    def __init__(self, number: int, publisher: Any) -> None:
        self.number = number
        self.publisher = publisher
        self.last: Any = None
        self.last_s = -math.inf
        self.told_s = -math.inf

    @property
    def limits(self) -> Limits:
        """As the last message says."""
        return Limits(self.last.min_range, self.last.max_range)


class RangeGuard(ArgusLifecycleNode):
    """The node."""

    def __init__(self) -> None:
        super().__init__("range_guard", parameters.RANGE_GUARD)
        self._active = False
        self._parts: list[Any] = []
        self._told: list[Verdict] = []

    def on_configure(self, state: Any) -> Any:
        """Read the parameters and subscribe."""
        del state
        return self.checked(self._configure)

    def _configure(self) -> None:
        self._policy = self.policy()
        self._robot = self.robot()
        topics, sonars = self._mapping()
        given = (text.partition("=") for text in self.value("settings") if text)
        self._ring = Ring(self._robot, {key: setting_value(key, text) for key, _, text in given})
        self._now_s = -math.inf
        self._sonars: dict[int, _Sonar] = {}
        suffix = self.value("suffix")
        for topic, number in zip(topics, sonars, strict=True):
            publisher = self.create_publisher(Range, topic + suffix, 10)
            sonar = self._sonars[number] = _Sonar(number, publisher)
            take = self._taker(sonar)
            self._parts += [publisher, self.create_subscription(Range, topic, take, qos_profile_sensor_data)]
        places = {k: deg for k, deg in bearings(self._robot).items() if k in self._sonars}
        self._covered_by = {k: neighbours(k, places) for k in places}
        self._cloud = self.create_publisher(PointCloud2, self.value("cloud"), 10)
        self._diagnostics = self.create_publisher(DiagnosticArray, "/diagnostics", 10)
        odometry = self.create_subscription(
            Odometry, self.value("odometry"), self._take_odometry, qos_profile_sensor_data
        )
        timer = self.create_timer(self.value("diagnostics_s"), self._diagnose)
        self._parts += [self._cloud, self._diagnostics, odometry, timer]

    def _mapping(self) -> tuple[Sequence[str], Sequence[int]]:
        topics, sonars = list(self.value("topics")), list(self.value("sonars"))
        if sonars == [-1]:
            sonars = list(range(len(topics)))
        if len(sonars) != len(topics):
            raise Refused(
                f"{len(topics)} topics but {len(sonars)} sonars: give one of the robot's for each topic"
            )
        if len(set(sonars)) != len(sonars) or not all(0 <= k < self._robot.sonars for k in sonars):
            raise Refused(f"sonars {sonars}: give each at most once, from 0 to {self._robot.sonars - 1}")
        if not self.value("suffix"):
            raise Refused("parameter suffix is empty: repaired readings may not go where the driver's go")
        return topics, sonars

    def on_activate(self, state: Any) -> Any:
        """Begin to publish."""
        self._active = True
        return super().on_activate(state)

    def on_deactivate(self, state: Any) -> Any:
        """Publish nothing; the fault manager still listens."""
        self._active = False
        return super().on_deactivate(state)

    def on_cleanup(self, state: Any) -> Any:
        """Give up all topics, and what was learned."""
        del state
        self._active = False
        return self.checked(self._drop)

    def _drop(self) -> None:
        for part in self._parts:
            self.discard(part)
        self._parts.clear()

    # ---- what comes

    def _taker(self, sonar: _Sonar) -> Any:
        return lambda message: self._take(sonar, message)

    def _seconds(self, message: Any) -> float:
        """Return the time of a message: its stamp, or that of the clock where it has none."""
        stamp = Time.from_msg(message.header.stamp)
        return float((stamp if stamp.nanoseconds else self.get_clock().now()).nanoseconds) / 1e9

    def _take_odometry(self, message: Any) -> None:
        pose, twist = message.pose.pose, message.twist.twist
        self._ring.motion = Motion(
            pose.position.x,
            pose.position.y,
            messages.yaw_of(pose.orientation),
            twist.linear.x,
            twist.angular.z,
        )

    def _take(self, sonar: _Sonar, message: Any) -> None:
        at_s = self._seconds(message)
        if at_s <= sonar.last_s and sonar.last_s - at_s < _COVER_AGE_S:
            return  # the same reading again
        sonar.last, sonar.last_s = message, at_s
        self._ring.note(sonar.number, message.range, sonar.limits)
        self._advance(at_s)
        if self._active:
            self._publish(sonar, at_s)
            for other in self._sonars.values():
                if sonar.number in self._covered_by[other.number] and at_s - other.told_s > _COVER_PERIOD_S:
                    self._cover(other, at_s)

    def _advance(self, at_s: float) -> None:
        if self._now_s - _COVER_AGE_S < at_s < self._now_s:
            return  # topics of one driver are not in order to the millisecond
        self._now_s = at_s
        if self._ring.advance(at_s) and self._active:
            self._publish_cloud()
        for event in self._ring.events():
            self.get_logger().debug(f"{event.event} {event.name} {event.value}")
        if self._ring.verdicts != self._told:
            self._diagnose()

    # ---- what goes

    def _trusted(self, number: int) -> bool:
        return self._ring.verdicts[number].trusted(self._policy.trust)

    def _covering(self, number: int) -> list[float]:
        found = []
        for k in self._covered_by[number]:
            other = self._sonars[k]
            is_fresh = self._now_s - other.last_s <= _COVER_AGE_S
            if self._trusted(k) and is_fresh and not math.isnan(other.last.range):
                found.append(float(other.last.range))
        return found

    def _publish(self, sonar: _Sonar, at_s: float) -> None:
        if self._trusted(sonar.number):
            value: float | None = self._policy.good(sonar.last.range, sonar.limits)
        else:
            value = self._policy.bad(self._covering(sonar.number), sonar.limits)
        self._say(sonar, value, at_s)

    def _cover(self, sonar: _Sonar, at_s: float) -> None:
        """Stand in for a sonar that no longer reports at all."""
        if sonar.last is not None and not self._trusted(sonar.number):
            self._say(sonar, self._policy.bad(self._covering(sonar.number), sonar.limits), at_s)

    def _say(self, sonar: _Sonar, value: float | None, at_s: float) -> None:
        if value is None:
            return
        sonar.told_s = at_s
        last = sonar.last
        message = messages.range_message(
            Time(nanoseconds=round(at_s * 1e9)).to_msg(),
            last.header.frame_id,
            value,
            sonar.limits,
            last.field_of_view,
        )
        message.radiation_type = last.radiation_type
        sonar.publisher.publish(message)

    def _publish_cloud(self) -> None:
        limit_s = self.value("cloud_age_s")
        echoes = [
            (sonar.number, sonar.last.range)
            for sonar in self._sonars.values()
            if self._trusted(sonar.number)
            and self._now_s - sonar.last_s <= limit_s
            and sonar.limits.is_echo(sonar.last.range)
        ]
        stamp = Time(nanoseconds=round(self._now_s * 1e9)).to_msg()
        self._cloud.publish(messages.cloud(stamp, self.value("base_frame"), echoes, self._robot.mounts))

    def _diagnose(self) -> None:
        if not self._active:
            return
        verdicts = self._ring.verdicts
        self._told = verdicts
        hardware = self._robot.subclass
        failure = self._ring.failure if self._now_s > -math.inf else None
        mapped = [v if k in self._sonars else Verdict("ABSENT") for k, v in enumerate(verdicts)]
        if failure is not None and len(self._sonars) < self._robot.sonars:
            failure = ""  # that of the fault manager counts sonars that this ring has not got
        counts = {"topics": len(self._sonars), "restarts": self._ring.restarts}
        statuses = [messages.ring_status(OWNER, failure, mapped, hardware, counts)]
        for number, sonar in self._sonars.items():
            known = sonar.last is not None and math.isfinite(sonar.last.range)
            reading_mm = round(sonar.last.range * 1000) if known else -1
            age_ms = round((self._now_s - sonar.last_s) * 1000) if sonar.last is not None else -1
            verdict = verdicts[number]
            statuses.append(messages.sonar_status(OWNER, number, verdict, reading_mm, age_ms, hardware))
        self._diagnostics.publish(messages.diagnostics(self.get_clock().now().to_msg(), statuses))
