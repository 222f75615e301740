# SPDX-License-Identifier: MIT
"""The node of a robot that argusd minds: its sonars, diagnoses, odometry and battery, and cmd_vel to its guard."""

from __future__ import annotations

import math
import time
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Final, TypeVar

from argus_tools.control import Client, ControlError
from argus_tools.control import Refused as OrderRefused
from argus_tools.control.client import default_place, read_token
from argus_tools.rings.intake import Limits, Odd, Order, speeds_of, stamp_of
from argus_tools.rings.motion import Motion
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Twist, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.duration import Duration
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import BatteryState, PointCloud2, Range
from std_srvs.srv import SetBool, Trigger

from argus_ros import messages, parameters
from argus_ros.base import LATCHED, ArgusLifecycleNode, Refused, SonarArray, TFMessage, type_name
from argus_ros.intake import Intake
from argus_ros.repair import Policy, Verdict, bearings, neighbours
from argus_ros.stamped import Beside
from argus_ros.watcher import Watcher
from argus_ros.wheels import Wheels
from hil_sim.tables import robots
from hil_sim.tables.robot import DEFAULT_ROBOT, RobotTable, robot_table

SILENT_S: Final = 1.5
SONARS: Final = 16
"""Of which there are topics before a robot has answered."""
_COVER_AGE_S: Final = 1.0


_T = TypeVar("_T")


class _Ring:
    """What was last said of each sonar."""

    def __init__(self, table: RobotTable) -> None:
        self.table = table
        self.limits = Limits(table.min_mm / 1000, table.no_echo_mm / 1000)
        self.view_rad = math.radians(table.cone_deg)
        self.covered_by = {k: neighbours(k, bearings(table)) for k in bearings(table)}
        self.verdicts = [Verdict()] * table.sonars
        self.reading_mm = [-1] * table.sonars
        self.age_ms = [-1] * table.sonars
        self.told_s = [-math.inf] * table.sonars

    def take_state(self, state: dict[str, Any]) -> None:
        """Take the verdicts of a state. Before the robot is known it may list fewer sonars than the ring has."""
        told = [Verdict(*pair) for pair in zip(state["health"], state["kind"], strict=True)]
        self.verdicts = self._all(told, Verdict())

    def take_readings(self, readings: dict[str, Any]) -> None:
        """Take readings, likewise; ages of -1 are of sonars that have not reported."""
        self.reading_mm, self.age_ms = self._all(readings["mm"], -1), self._all(readings["age_ms"], -1)

    def _all(self, told: list[_T], missing: _T) -> list[_T]:
        return (told + [missing] * self.table.sonars)[: self.table.sonars]

    def covering(self, number: int, policy: Policy) -> list[float]:
        """Return the readings that stand in for a sonar."""
        return [
            self.reading_mm[k] / 1000
            for k in self.covered_by[number]
            if self.verdicts[k].trusted(policy.trust) and 0 <= self.age_ms[k] <= _COVER_AGE_S * 1000
        ]

    def value(self, number: int, policy: Policy) -> float | None:
        """Return what is published of a sonar now."""
        if self.verdicts[number].trusted(policy.trust):
            return policy.good(self.reading_mm[number] / 1000, self.limits)
        return policy.bad(self.covering(number, policy), self.limits)


class ArgusNode(ArgusLifecycleNode):
    """The node."""

    _watcher: Watcher | None = None
    _wheels: Wheels | None = None
    _stamped: Beside | None = None

    def __init__(self, **options: Any) -> None:
        super().__init__("argus", parameters.ARGUS, **options)

    # ---- lifecycle

    def _configure(self) -> None:
        self._framed: RobotTable | None = None
        self._forget()
        self._told: list[Verdict] = []
        self._diagnosed_s = -math.inf
        self._connection = 0
        self._intake = Intake(self._tell_odd)
        self._order_of_stamps = Order()
        namespace = self.get_namespace().strip("/")
        self._place = self.value("control") or default_place(namespace)
        try:
            file = self.value("token_file")
            self._token = read_token(Path(file)) if file else None
        except ControlError as error:
            raise Refused(f"parameter token_file: {error}") from error
        self._make_topics()
        self._make_services()
        wake = self.create_guard_condition(self._take)
        self._parts.append(wake)
        self._watcher = Watcher(self._place, self._token, self.value("period_ms"), wake.trigger)
        guard = parameters.host_and_port(self.value("guard"))
        if guard is not None:
            self._make_wheels(guard)

    def _make_wheels(self, guard: tuple[str, int]) -> None:
        """Take cmd_vel as either type, from publishers reliable or not."""
        self._wheels = Wheels(*guard, self.value("cmd_vel_timeout_s"), self.get_logger().info)
        qos = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        take = self._intake.taker("cmd_vel", self._take_twist)
        self.take_topic(Twist, "cmd_vel", take, qos)
        self._taken["cmd_vel"] += f" {type_name(TwistStamped)}"
        wake = self.create_guard_condition(self._take_stamped)
        self._parts.append(wake)
        self._stamped = self._stamped or Beside(self)
        self._stamped.join(TwistStamped, self.resolve_topic_name("cmd_vel"), qos, wake.trigger)

    def _forget(self) -> None:
        """Forget what one connection to argusd told: its clock and its verdicts end with it."""
        self._ring: _Ring | None = None
        self._state: dict[str, Any] = {}
        self._state_s = self._readings_s = -math.inf

    def _make_topics(self) -> None:
        self._ranges: list[Any] = []
        self._make_ranges(SONARS)
        self._cloud = self.publisher(PointCloud2, "sonar/cloud")
        self._odometry = self.publisher(Odometry, "pose")
        self._battery = self.publisher(BatteryState, "battery_state")
        self._diagnostics = self.publisher(DiagnosticArray, "/diagnostics")
        self._array = self._tf = self._tf_static = None
        if SonarArray is not None:
            self._array = self.publisher(SonarArray, "sonar")
        if self.value("publish_tf"):
            if TFMessage is None:
                self.get_logger().warning("no tf: the package tf2_msgs is not here (docs/ros.md)")
            else:
                self._tf = self.publisher(TFMessage, "/tf", 100)
                self._tf_static = self.publisher(TFMessage, "/tf_static", LATCHED)

    def _make_ranges(self, count: int) -> None:
        """Publish the ranges of COUNT sonars."""
        for k in range(len(self._ranges), count):
            self._ranges.append(self.publisher(Range, f"sonar/range_{k}"))

    def _make_services(self) -> None:
        def trigger(name: str, order: str, **members: Any) -> None:
            def serve(request: Any, response: Any) -> Any:
                del request
                return self._order(response, order, **members)

            self._parts.append(self.create_service(Trigger, name, serve))

        def switch(name: str, on: str, off: str, **members: Any) -> None:
            def serve(request: Any, response: Any) -> Any:
                return self._order(response, on if request.data else off, **members)

            self._parts.append(self.create_service(SetBool, name, serve))

        trigger("sonar/recheck", "recheck")
        switch("passive", "passive", "active")
        self._trigger, self._switch = trigger, switch
        self._served = 0
        self._serve_sonars(SONARS)

    def _serve_sonars(self, count: int) -> None:
        """Take orders about COUNT sonars."""
        for k in range(self._served, count):
            self._trigger(f"sonar/retest_{k}", "retest", sonar=k)
            self._switch(f"sonar/pin_{k}", "pin", "unpin", sonar=k)
        self._served = max(self._served, count)

    def _rest(self) -> None:
        """Stop the robot if it drives by cmd_vel."""
        if self._wheels is not None:
            self._wheels.halt()

    def _close(self) -> None:
        """Leave the guard, then argusd."""
        wheels, watcher = self._wheels, self._watcher
        self._wheels = self._watcher = None
        with ExitStack() as ends:  # in turn from the last, each whatever becomes of the others
            if watcher is not None:
                ends.callback(watcher.close)
            if self._stamped is not None:
                ends.callback(self._stamped.leave)
            if wheels is not None:
                ends.callback(wheels.close)

    def _finish(self) -> None:
        """End the second participant, which is kept from one configuration to the next."""
        stamped, self._stamped = self._stamped, None
        if stamped is not None:
            stamped.close()

    # ---- what comes

    def _order(self, response: Any, order: str, **members: Any) -> Any:
        """Give an order on a connection of its own: control is held no longer than that takes."""
        try:
            with Client(self._place, self._token, timeout_s=2.0) as argus:
                argus.take()
                argus.order(order, **members)
            response.success, response.message = True, f"{order}: done"
        except (ControlError, OrderRefused, TimeoutError) as error:
            response.success, response.message = False, f"{order}: {error}"
        return response

    def _take_stamped(self) -> None:
        if self._stamped is not None:
            take = self._intake.taker("cmd_vel", self._take_twist_stamped)
            for message in self._stamped.take():
                take(message)

    def _take_twist_stamped(self, message: Any) -> None:
        at_s = stamp_of(message.header)
        if at_s is not None:
            if self.get_clock().now().nanoseconds / 1e9 - at_s > self.value("cmd_vel_timeout_s"):
                raise Odd("stamp is older than cmd_vel_timeout_s")
            self._order_of_stamps.check(at_s)
        self._take_twist(message.twist)

    def _take_twist(self, twist: Any) -> None:
        if not self._active or self._wheels is None:
            return
        try:
            speed, turn = speeds_of(twist)
        except Odd:
            self._wheels.halt()
            raise
        most, most_turn = self.value("max_speed_m_s"), self.value("max_turn_rad_s")
        speed, turn = max(-most, min(most, speed)), max(-most_turn, min(most_turn, turn))
        self._wheels.drive(round(speed * 1000), round(math.degrees(turn)))

    def _tell_odd(self, topic: str, why: str) -> None:
        self.get_logger().warning(f"{topic}: discarded: {why}")
        self._diagnosed_s = -math.inf

    def _take(self) -> None:
        if self._watcher is None:
            return
        for connection, message in self._watcher.take():
            if connection != self._connection:
                self._connection = connection
                self._forget()
            if "readings" in message:
                self._take_readings(message["readings"])
            elif message.get("event") == "STATUS":
                self._take_state(message)
            elif "event" in message:
                self._take_event(message)
        if not self._watcher.connected and self._state:
            self._forget()
            self._diagnose()

    def _take_event(self, event: dict[str, Any]) -> None:
        words, level = f"{event.get('event')} {event.get('name')} {event.get('value')}", event.get("level")
        # Each on a line of its own: rclpy takes one severity from one place.
        if level == messages.ERROR:
            self.get_logger().error(words)
        elif level == messages.OK:
            self.get_logger().info(words)
        else:
            self.get_logger().warning(words)

    def _take_state(self, state: dict[str, Any]) -> None:
        self._state, self._state_s = state, time.monotonic()
        announced = str(state.get("subclass"))
        table = robot_table(self.value("robot") or (announced if announced in robots() else DEFAULT_ROBOT))
        if self._ring is None or self._ring.table != table:
            self._meet(table)
        assert self._ring is not None
        if self._framed != table and (self.value("robot") or state.get("online")):
            self._frame(table)
        self._ring.take_state(state)
        if self._ring.verdicts != self._told:
            self._diagnose()
        if self._active and state.get("online") and self._has_time():
            self._publish_motion(self._motion(self._ring.table), state)

    def _meet(self, table: RobotTable) -> None:
        self._ring = _Ring(table)
        self._make_ranges(table.sonars)
        self._serve_sonars(table.sonars)

    def _frame(self, table: RobotTable) -> None:
        """Publish where the sonars are, once it is known which robot it is."""
        self._framed = table
        if self._tf_static is None:
            return
        at, base, prefix = self._now(), self.frame("base_link_frame_id"), self.frame("sonar_frame_prefix")
        height_m = self.value("sonar_z_m")
        frames = [
            messages.transform(
                at,
                base,
                f"{prefix}{k}",
                m.x_mm / 1000,
                m.y_mm / 1000,
                height_m,
                math.radians(m.heading_deg),
            )
            for k, m in enumerate(table.mounts)
        ]
        self._tf_static.publish(TFMessage(transforms=frames))

    def _motion(self, table: RobotTable) -> Motion:
        state = self._state
        left, right = state["vel_left_mm_s"], state["vel_right_mm_s"]
        return Motion(
            state["x_mm"] / 1000,
            state["y_mm"] / 1000,
            math.radians(state["heading_cdeg"] / 100),
            (left + right) / 2000,
            (right - left) / table.motion["track_mm"],
        )

    def _take_readings(self, readings: dict[str, Any]) -> None:
        ring = self._ring
        if ring is None:
            return
        ring.take_readings(readings)
        self._readings_s = time.monotonic()
        if not self._active or not self._has_time():
            return
        policy, now = self.policy(), self.get_clock().now()
        for k in range(ring.table.sonars):
            at_s = readings["t"] - ring.age_ms[k] / 1000
            is_fresh = ring.age_ms[k] >= 0 and at_s > ring.told_s[k] + 1e-3
            stands_in = not ring.verdicts[k].trusted(policy.trust) and bool(ring.covering(k, policy))
            if is_fresh or stands_in:
                ring.told_s[k] = at_s
                age_ns = ring.age_ms[k] * 1_000_000 if is_fresh else 0
                if age_ns < now.nanoseconds:  # before the beginning of a simulated time there is no stamp
                    self._publish_range(k, policy, (now - Duration(nanoseconds=age_ns)).to_msg())
        self._publish_cloud(policy, now.to_msg())
        if self._array is not None:
            values = [ring.value(k, policy) for k in range(ring.table.sonars)]
            known = [math.nan if value is None else value for value in values]
            at = messages.header(now.to_msg(), self.frame("base_link_frame_id"))
            self._array.publish(SonarArray(header=at, ranges_count=len(known), ranges=known))

    # ---- what goes

    def _now(self) -> Any:
        return self.get_clock().now().to_msg()

    def _has_time(self) -> bool:
        """Whether there is a time to stamp with: with use_sim_time not before the first /clock."""
        return bool(self.get_clock().now().nanoseconds > 0)

    def _publish_range(self, number: int, policy: Policy, at: Any) -> None:
        assert self._ring is not None
        value = self._ring.value(number, policy)
        if value is None:
            return
        frame = f"{self.frame('sonar_frame_prefix')}{number}"
        message = messages.range_message(at, frame, value, self._ring.limits, self._ring.view_rad)
        self._ranges[number].publish(message)

    def _publish_cloud(self, policy: Policy, at: Any) -> None:
        ring = self._ring
        assert ring is not None
        limit_ms = self.value("cloud_age_s") * 1000
        echoes = [
            (k, ring.reading_mm[k] / 1000)
            for k in range(ring.table.sonars)
            if ring.verdicts[k].trusted(policy.trust)
            and 0 <= ring.age_ms[k] <= limit_ms
            and ring.limits.is_echo(ring.reading_mm[k] / 1000)
        ]
        self._cloud.publish(messages.cloud(at, self.frame("base_link_frame_id"), echoes, ring.table.mounts))

    def _publish_motion(self, motion: Motion, state: dict[str, Any]) -> None:
        at, odom, base = self._now(), self.frame("odom_frame_id"), self.frame("base_link_frame_id")
        self._odometry.publish(messages.odometry(at, odom, base, motion))
        self._battery.publish(messages.battery(at, base, state["battery_dv"] / 10))
        if self._tf is not None:
            frame = messages.transform(at, odom, base, motion.x_m, motion.y_m, 0.0, motion.heading_rad)
            self._tf.publish(TFMessage(transforms=[frame]))

    def _tick(self) -> None:
        if self._wheels is not None:
            self._wheels.timeout_s = self.value("cmd_vel_timeout_s")
        is_blind = self._blind() != ""
        if is_blind != self._was_blind or time.monotonic() - self._diagnosed_s >= self.value("diagnostics_s"):
            self._was_blind = is_blind
            self._diagnose()

    _was_blind = True

    def _blind(self) -> str:
        """Return why nothing is judged now; empty when all is."""
        now_s = time.monotonic()
        if not self._has_time():
            return "use_sim_time is set, and no /clock has come"
        if not self._state or self._ring is None:
            return "no argusd"
        if not self._state.get("online"):
            return "no robot"
        if now_s - self._readings_s > SILENT_S and now_s - self._state_s > SILENT_S:
            return "argusd reports nothing"
        if now_s - self._readings_s > SILENT_S:
            return "no readings come"
        return ""

    def _diagnose(self) -> None:
        if not self._active:
            return
        self._diagnosed_s = time.monotonic()
        ring, state, blind = self._ring, self._state, self._blind()
        if ring is None or not state:
            why = self._watcher.why_not if self._watcher is not None else ""
            statuses = [messages.ring_status(self.owner, None, [], "", {"argusd": why}, blind)]
        else:
            self._told = ring.verdicts
            statuses = self._statuses(ring, state, blind)
        if self._wheels is not None:
            statuses.append(self._cmd_vel_status(self._wheels))
        statuses.append(self.topics_status())
        self._diagnostics.publish(messages.diagnostics(self._now(), statuses))

    def _cmd_vel_status(self, wheels: Wheels) -> Any:
        """Return whether cmd_vel is carried out, and if not, why."""
        found = self.get_publishers_info_by_topic("cmd_vel")
        types = {info.topic_type for info in found}
        foreign = sorted(types - {*self._taken["cmd_vel"].split()})
        last = self._intake.last.get("cmd_vel", "")
        level, words = messages.OK, "carried out" if found else "nobody publishes it"
        if last:
            level, words = messages.WARN, f"discarded: {last}"
        if foreign:
            level, words = messages.ERROR, f"published as {foreign[0]}: Twist and TwistStamped are taken"
        if not wheels.connected:
            level, words = messages.ERROR, f"goes nowhere: {wheels.why_not}"
        values = {
            "guard": self.value("guard"),
            "publishers": len(found),
            "types": " ".join(sorted(types)) or "none",
            "discarded": self._intake.discarded("cmd_vel"),
            "last_discarded": last or "none",
        }
        return messages.status(level, f"{self.owner}: cmd_vel", words, "", values)

    def _statuses(self, ring: _Ring, state: dict[str, Any], blind: str) -> list[Any]:
        """Return the diagnoses of the ring and of each sonar."""
        hardware = str(state.get("robot") or ring.table.subclass)
        failure = str(state.get("failure", state["state"])) if not blind else None
        keys = ("mode", "mission", "active", "link", "sips", "bad_checksums")
        more = {key: state.get(key, "") for key in keys}
        injected = list(state.get("injected", []))
        more["injected"] = messages.injected_words(injected)
        injected += [""] * (ring.table.sonars - len(injected))
        statuses = [messages.ring_status(self.owner, failure, ring.verdicts, hardware, more, blind)]
        since_ms = int(1000 * min(1e6, time.monotonic() - self._readings_s))
        for k in range(ring.table.sonars):
            own = {"injected": injected[k] or "none"}
            verdict, mm, age_ms = ring.verdicts[k], ring.reading_mm[k], ring.age_ms[k]
            age_ms = age_ms + since_ms if age_ms >= 0 else age_ms
            statuses.append(messages.sonar_status(self.owner, k, verdict, mm, age_ms, hardware, own))
        return statuses
