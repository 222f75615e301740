# SPDX-License-Identifier: MIT
"""range_guard: takes the Range topics of any driver, runs the fault manager on them, and publishes repaired ones."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from typing import Any, Final

from argus_tools.rings.intake import Limits, Odd, Order, limits_of, motion_of, stamp_of
from diagnostic_msgs.msg import DiagnosticArray
from nav_msgs.msg import Odometry
from rclpy.qos import qos_profile_sensor_data
from rclpy.time import Time
from sensor_msgs.msg import PointCloud2, Range

from argus_ros import messages, parameters
from argus_ros.base import ArgusLifecycleNode, Refused
from argus_ros.intake import Intake
from argus_ros.repair import Policy, Verdict, bearings, neighbours
from argus_ros.ring import Ring
from argus_ros.timeline import Pace, Timeline
from hil_sim.core.library import setting_value

_COVER_AGE_S: Final = 1.0
_COVER_PERIOD_S: Final = 0.25
_SILENT_S: Final = 1.5
_ODOMETRY_S: Final = 2.0
_ANEW_S: Final = 3.0


class _Sonar:
    """One topic: the last of its messages that holds, and where the repaired readings go."""

    def __init__(self, number: int, topic: str, publisher: Any) -> None:
        self.number = number
        self.topic = topic
        self.publisher = publisher
        self.last: Any = None
        self.limits = Limits(0.0, 0.0)
        self.last_s = -math.inf
        self.told_s = -math.inf
        self.heard_s = -math.inf
        """By the steady clock."""


class RangeGuard(ArgusLifecycleNode):
    """The node."""

    def __init__(self, **options: Any) -> None:
        super().__init__("range_guard", parameters.RANGE_GUARD, **options)

    def _configure(self) -> None:
        self._robot = self.robot()
        topics, sonars = self._mapping()
        given = (text.partition("=") for text in self.value("settings") if text)
        self._settings = {key: setting_value(key, text) for key, _, text in given}
        self._ring = Ring(self._robot, self._settings)
        self._timeline, self._pace, self._odometry_order = Timeline(), Pace(), Order()
        self._intake = Intake(self._tell_odd)
        self._told: list[Verdict] = []
        self._judged_s = self._motion_s = self._anew_s = self._diagnosed_s = -math.inf
        self._was_blind = True
        self._sonars: dict[int, _Sonar] = {}
        suffix = self.value("suffix")
        for topic, number in zip(topics, sonars, strict=True):
            publisher = self.publisher(Range, topic + suffix)
            sonar = self._sonars[number] = _Sonar(number, topic, publisher)
            self.take_topic(
                Range, topic, self._intake.taker(topic, self._taker(sonar)), qos_profile_sensor_data
            )
        self._by_topic = {sonar.topic: sonar for sonar in self._sonars.values()}
        places = {k: deg for k, deg in bearings(self._robot).items() if k in self._sonars}
        self._covered_by = {k: neighbours(k, places) for k in places}
        self._cloud = self.publisher(PointCloud2, self.value("cloud"))
        self._diagnostics = self.publisher(DiagnosticArray, "/diagnostics")
        self._odometry_topic = self.value("odometry")
        take = self._intake.taker(self._odometry_topic, self._take_odometry)
        self.take_topic(Odometry, self._odometry_topic, take, qos_profile_sensor_data)

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
        return topics, sonars

    # ---- what comes

    def _taker(self, sonar: _Sonar) -> Any:
        return lambda message: self._take(sonar, message)

    def _seconds(self, message: Any) -> float:
        """Return the time of a message: its stamp, or that of the clock where it has none."""
        stamp_s = stamp_of(message.header)
        if stamp_s is None:
            stamp_s = float(self.get_clock().now().nanoseconds) / 1e9
        if stamp_s <= 0:
            raise Odd("it has no stamp, and no /clock has come")
        return stamp_s

    def _take_odometry(self, message: Any) -> None:
        at_s, motion = self._seconds(message), motion_of(message)
        self._odometry_order.check(at_s)
        self._ring.motion = motion
        self._motion_s = time.monotonic()

    def _take(self, sonar: _Sonar, message: Any) -> None:
        at_s, steady_s = self._seconds(message), time.monotonic()
        limits_of(message)
        before = self._timeline.jumps
        for topic, one_s, one in self._timeline.take(sonar.topic, at_s, message, steady_s):
            self._use(self._by_topic[topic], one_s, one)
        if self._timeline.jumps != before or self._anew_s == -math.inf:
            self._anew_s = self._timeline.now_s

    def _use(self, sonar: _Sonar, at_s: float, message: Any) -> None:
        """Judge a message on the ring's time, and repair it."""
        sonar.last, sonar.last_s, sonar.limits = message, at_s, limits_of(message)
        sonar.heard_s = self._judged_s = time.monotonic()
        self._intake.last.pop(sonar.topic, None)
        self._ring.note(sonar.number, message.range, sonar.limits)
        self._advance(max(at_s, self._timeline.now_s))
        if self._active:
            policy = self.policy()
            self._publish(sonar, policy, at_s)
            for other in self._sonars.values():
                if (
                    sonar.number in self._covered_by[other.number]
                    and not 0 <= at_s - other.told_s <= _COVER_PERIOD_S
                ):
                    self._cover(other, policy, at_s)

    def _advance(self, at_s: float) -> None:
        self._ring.advance(at_s)
        if self._pace.is_due(at_s) and self._active:
            self._publish_cloud()
        for event in self._ring.events():
            self.get_logger().debug(f"{event.event} {event.name} {event.value}")
        if self._ring.verdicts != self._told:
            self._diagnose()

    # ---- what goes

    def _trusted(self, number: int, policy: Policy) -> bool:
        """Whether a sonar's readings may be used: its messages hold, and it has no fault."""
        odd = self._sonars[number].topic in self._intake.last
        return not odd and self._ring.verdicts[number].trusted(policy.trust)

    def _age_s(self, sonar: _Sonar) -> float:
        """How old the last reading of a sonar is; with a clock that stands, by the steady one."""
        return max(self._timeline.now_s - sonar.last_s, time.monotonic() - self._judged_s - _SILENT_S)

    def _covering(self, number: int, policy: Policy) -> list[float]:
        found = []
        for k in self._covered_by[number]:
            other = self._sonars[k]
            is_fresh = self._age_s(other) <= _COVER_AGE_S
            if self._trusted(k, policy) and is_fresh and not math.isnan(other.last.range):
                found.append(float(other.last.range))
        return found

    def _publish(self, sonar: _Sonar, policy: Policy, at_s: float) -> None:
        if self._trusted(sonar.number, policy):
            value: float | None = policy.good(sonar.last.range, sonar.limits)
        else:
            value = policy.bad(self._covering(sonar.number, policy), sonar.limits)
        self._say(sonar, value, at_s)

    def _cover(self, sonar: _Sonar, policy: Policy, at_s: float) -> None:
        """Stand in for a sonar that no longer reports at all, or nothing that holds."""
        if sonar.last is not None and not self._trusted(sonar.number, policy):
            self._say(sonar, policy.bad(self._covering(sonar.number, policy), sonar.limits), at_s)

    def _say(self, sonar: _Sonar, value: float | None, at_s: float) -> None:
        if value is None:
            return
        sonar.told_s = at_s
        stamp = Time(nanoseconds=round(at_s * 1e9)).to_msg()
        sonar.publisher.publish(messages.repaired(sonar.last, stamp, value))

    def _publish_cloud(self) -> None:
        limit_s, now_s, policy = self.value("cloud_age_s"), self._timeline.now_s, self.policy()
        echoes = [
            (sonar.number, sonar.last.range)
            for sonar in self._sonars.values()
            if sonar.last is not None
            and self._trusted(sonar.number, policy)
            and 0 <= now_s - sonar.last_s <= limit_s
            and sonar.limits.is_echo(sonar.last.range)
        ]
        stamp = Time(nanoseconds=round(now_s * 1e9)).to_msg()
        self._cloud.publish(messages.cloud(stamp, self.frame("base_frame"), echoes, self._robot.mounts))

    # ---- what is diagnosed

    def _tell_odd(self, topic: str, why: str) -> None:
        self.get_logger().warning(f"{topic}: discarded: {why}")
        self._diagnosed_s = -math.inf

    def _tick(self) -> None:
        steady_s, is_blind = time.monotonic(), bool(self._blind())
        if is_blind != self._was_blind or steady_s - self._diagnosed_s >= self.value("diagnostics_s"):
            self._was_blind = is_blind
            self._diagnose()

    def _blind(self) -> str:
        """Return why nothing is judged; empty when something is."""
        if time.monotonic() - self._judged_s <= _SILENT_S:
            return ""
        odd = next(iter(self._intake.last.items()), None)
        return f"no readings are judged: {odd[0]}: {odd[1]}" if odd else "no readings come"

    def _doubts(self) -> list[str]:
        """Return why not all is judged as it should be."""
        found, steady_s = [], time.monotonic()
        odd = [sonar for sonar in self._sonars.values() if sonar.topic in self._intake.last]
        if odd:
            numbers = " ".join(str(sonar.number) for sonar in odd)
            found.append(f"discarded of sonars {numbers}: {self._intake.last[odd[0].topic]}")
        verdicts = self._ring.verdicts
        mute = [
            str(sonar.number)
            for sonar in self._sonars.values()
            if sonar not in odd
            and not verdicts[sonar.number].kind
            and steady_s - sonar.heard_s > _SILENT_S
            and verdicts[sonar.number].health != "ABSENT"
        ]
        if mute:
            found.append(f"nothing of sonars {' '.join(mute)}")
        if self._odometry_topic in self._intake.last:
            found.append(f"odometry discarded: {self._intake.last[self._odometry_topic]}")
        elif self._motion_s == -math.inf:
            found.append("no odometry")
        elif steady_s - self._motion_s > _ODOMETRY_S:
            found.append("odometry comes no more")
        if self._timeline.now_s - self._anew_s < _ANEW_S:
            found.append("begun anew: the clock jumped" if self._timeline.jumps else "begun just now")
        if self._settings.get("diagnosis") == 0:
            found.append("nothing is judged: the setting diagnosis is off")
        return found

    def _diagnose(self) -> None:
        if not self._active:
            return
        self._diagnosed_s = time.monotonic()
        verdicts = self._ring.verdicts
        self._told = verdicts
        hardware, blind = self._robot.subclass, self._blind()
        failure = self._ring.failure if not blind else None
        mapped = [v if k in self._sonars else Verdict("ABSENT") for k, v in enumerate(verdicts)]
        if failure is not None and len(self._sonars) < self._robot.sonars:
            failure = ""  # that of the fault manager counts sonars that this ring has not got
        counts = {
            "topics": len(self._sonars),
            "restarts": self._ring.restarts,
            "discarded": self._intake.discarded(),
        }
        doubt = blind or "; ".join(self._doubts())
        statuses = [messages.ring_status(self.owner, failure, mapped, hardware, counts, doubt)]
        statuses += [self._sonar_status(sonar, verdicts[k], hardware) for k, sonar in self._sonars.items()]
        statuses.append(self.topics_status())
        self._diagnostics.publish(messages.diagnostics(self.get_clock().now().to_msg(), statuses))

    def _sonar_status(self, sonar: _Sonar, verdict: Verdict, hardware: str) -> Any:
        known = sonar.last is not None and math.isfinite(sonar.last.range)
        reading_mm = round(sonar.last.range * 1000) if known else -1
        age_ms = round(self._age_s(sonar) * 1000) if sonar.last is not None else -1
        more = {"discarded": self._intake.discarded(sonar.topic)}
        odd = self._intake.last.get(sonar.topic, "")
        return messages.sonar_status(
            self.owner, sonar.number, verdict, reading_mm, age_ms, hardware, more, odd
        )
