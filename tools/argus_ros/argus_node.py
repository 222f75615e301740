# SPDX-License-Identifier: MIT
"""The node of a robot that argusd minds: its sonars, diagnoses, odometry and battery, and cmd_vel to its guard."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Final

from argus_tools.control import Client, ControlError
from argus_tools.control import Refused as OrderRefused
from argus_tools.control.client import default_place, read_token
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.duration import Duration
from sensor_msgs.msg import BatteryState, PointCloud2, Range
from std_srvs.srv import SetBool, Trigger

from argus_ros import messages, parameters
from argus_ros.base import LATCHED, ArgusLifecycleNode, Refused, SonarArray, TFMessage
from argus_ros.repair import Limits, Policy, Verdict, bearings, neighbours
from argus_ros.ring import Motion
from argus_ros.watcher import Watcher
from argus_ros.wheels import Wheels
from hil_sim.tables import load, robots
from hil_sim.tables.robot import DEFAULT_ROBOT, RobotTable, robot_table

OWNER: Final = "argus"
SONARS: Final = 16
_COVER_AGE_S: Final = 1.0


class _Ring:
    """What was last said of each sonar."""

    def __init__(self, table: RobotTable) -> None:
        sonar = load(f"robots/{table.subclass}")["sonar"]
        self.table = table
        self.limits = Limits(sonar["min_mm"] / 1000, sonar["no_echo_mm"] / 1000)
        self.view_rad = math.radians(sonar["cone_deg"])
        self.covered_by = {k: neighbours(k, bearings(table)) for k in bearings(table)}
        self.verdicts = [Verdict()] * SONARS
        self.reading_mm = [-1] * SONARS
        self.age_ms = [-1] * SONARS
        self.told_s = [-math.inf] * SONARS

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

    def __init__(self) -> None:
        super().__init__("argus", parameters.ARGUS)
        self._active = False
        self._parts: list[Any] = []
        self._ring: _Ring | None = None
        self._state: dict[str, Any] = {}
        self._told: list[Verdict] = []

    # ---- lifecycle

    def on_configure(self, state: Any) -> Any:
        """Read the parameters, and reach for argusd."""
        del state
        return self.checked(self._configure)

    def _configure(self) -> None:
        self._policy = self.policy()
        self._place = self.value("control") or default_place()
        if not self._place.startswith(("unix:", "tcp:")):
            raise Refused(f"parameter control is '{self._place}': give unix:PATH or tcp:HOST:PORT")
        try:
            file = self.value("token_file")
            self._token = read_token(Path(file)) if file else None
        except ControlError as error:
            raise Refused(f"parameter token_file: {error}") from error
        guard = self._guard()
        self._make_topics()
        self._make_services()
        wake = self.create_guard_condition(self._take)
        self._parts.append(wake)
        self._watcher = Watcher(self._place, self._token, self.value("period_ms"), wake.trigger)
        if guard is not None:
            tell = self.get_logger().info
            self._wheels = Wheels(*guard, self.value("cmd_vel_timeout_s"), tell)
            self._parts.append(self.create_subscription(Twist, "cmd_vel", self._take_twist, 1))

    def _guard(self) -> tuple[str, int] | None:
        text = self.value("guard")
        if not text:
            return None
        host, _, port = text.rpartition(":")
        if not host or not port.isdigit() or not 0 < int(port) < 65536:
            raise Refused(f"parameter guard is '{text}': give HOST:PORT")
        return host, int(port)

    def _make_topics(self) -> None:
        self._ranges = [self.create_publisher(Range, f"sonar/range_{k}", 10) for k in range(SONARS)]
        self._cloud = self.create_publisher(PointCloud2, "sonar/cloud", 10)
        self._odometry = self.create_publisher(Odometry, "pose", 10)
        self._battery = self.create_publisher(BatteryState, "battery_state", 10)
        self._diagnostics = self.create_publisher(DiagnosticArray, "/diagnostics", 10)
        self._parts += [*self._ranges, self._cloud, self._odometry, self._battery, self._diagnostics]
        self._array = self._tf = self._tf_static = None
        if SonarArray is not None:
            self._array = self.create_publisher(SonarArray, "sonar", 10)
            self._parts.append(self._array)
        if self.value("publish_tf"):
            if TFMessage is None:
                self.get_logger().warning("no tf: the package tf2_msgs is not here (docs/ros.md)")
            else:
                self._tf = self.create_publisher(TFMessage, "/tf", 100)
                self._tf_static = self.create_publisher(TFMessage, "/tf_static", LATCHED)
                self._parts += [self._tf, self._tf_static]
        self._parts.append(self.create_timer(self.value("diagnostics_s"), self._diagnose))

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
        for k in range(SONARS):
            trigger(f"sonar/retest_{k}", "retest", sonar=k)
            switch(f"sonar/pin_{k}", "pin", "unpin", sonar=k)

    def on_activate(self, state: Any) -> Any:
        """Begin to publish and to drive."""
        self._active = True
        return super().on_activate(state)

    def on_deactivate(self, state: Any) -> Any:
        """Stop the robot if it drives by cmd_vel, and publish nothing."""
        self._active = False
        if self._wheels is not None:
            self._wheels.drive(0, 0)
        return super().on_deactivate(state)

    def on_cleanup(self, state: Any) -> Any:
        """Leave argusd and the guard."""
        del state
        return self.checked(self._drop)

    def _drop(self) -> None:
        self._active = False
        for thread in (self._watcher, self._wheels):
            if thread is not None:
                thread.close()
        self._watcher = self._wheels = self._ring = None
        for part in self._parts:
            self.discard(part)
        self._parts.clear()

    def destroy_node(self) -> None:
        """End the threads, then the node; it may be one that was not made whole."""
        for thread in (self._watcher, self._wheels):
            if thread is not None:
                thread.close()
        super().destroy_node()

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

    def _take_twist(self, twist: Any) -> None:
        speed, turn = twist.linear.x, twist.angular.z
        if not self._active or self._wheels is None:
            return
        if not (math.isfinite(speed) and math.isfinite(turn)):
            self.get_logger().warning(
                "a cmd_vel that is no number stops the robot", throttle_duration_sec=1.0
            )
            speed = turn = 0.0
        most, most_turn = self.value("max_speed_m_s"), self.value("max_turn_rad_s")
        speed, turn = max(-most, min(most, speed)), max(-most_turn, min(most_turn, turn))
        self._wheels.drive(round(speed * 1000), round(math.degrees(turn)))

    def _take(self) -> None:
        if self._watcher is None:
            return
        for message in self._watcher.take():
            if "readings" in message:
                self._take_readings(message["readings"])
            elif message.get("event") == "STATUS":
                self._take_state(message)
            elif "event" in message:
                self._take_event(message)
        if not self._watcher.connected and self._state:
            self._state = {}
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
        self._state = state
        if self._ring is None:
            self._meet(str(state.get("subclass") or DEFAULT_ROBOT))
        assert self._ring is not None
        self._ring.verdicts = [Verdict(*pair) for pair in zip(state["health"], state["kind"], strict=True)]
        if self._ring.verdicts != self._told:
            self._diagnose()
        if self._active and state.get("online"):
            self._publish_motion(self._motion(self._ring.table), state)

    def _meet(self, subclass: str) -> None:
        name = subclass if subclass in robots() else DEFAULT_ROBOT
        self._ring = _Ring(robot_table(name))
        if self._tf_static is None:
            return
        at, base, prefix = self._now(), self.value("base_link_frame_id"), self.value("sonar_frame_prefix")
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
            for k, m in enumerate(self._ring.table.mounts)
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
        ring.reading_mm, ring.age_ms = readings["mm"], readings["age_ms"]
        if not self._active:
            return
        now = self.get_clock().now()
        for k in range(ring.table.sonars):
            at_s = readings["t"] - ring.age_ms[k] / 1000
            is_fresh = ring.age_ms[k] >= 0 and at_s > ring.told_s[k] + 1e-3
            stands_in = not ring.verdicts[k].trusted(self._policy.trust) and bool(
                ring.covering(k, self._policy)
            )
            if is_fresh or stands_in:
                ring.told_s[k] = at_s
                age_ms = ring.age_ms[k] if is_fresh else 0
                self._publish_range(k, (now - Duration(nanoseconds=age_ms * 1_000_000)).to_msg())
        self._publish_cloud(now.to_msg())
        if self._array is not None:
            values = [ring.value(k, self._policy) for k in range(ring.table.sonars)]
            known = [math.nan if value is None else value for value in values]
            at = messages.header(now.to_msg(), self.value("base_link_frame_id"))
            self._array.publish(SonarArray(header=at, ranges_count=len(known), ranges=known))

    # ---- what goes

    def _now(self) -> Any:
        return self.get_clock().now().to_msg()

    def _publish_range(self, number: int, at: Any) -> None:
        assert self._ring is not None
        value = self._ring.value(number, self._policy)
        if value is None:
            return
        frame = f"{self.value('sonar_frame_prefix')}{number}"
        message = messages.range_message(at, frame, value, self._ring.limits, self._ring.view_rad)
        self._ranges[number].publish(message)

    def _publish_cloud(self, at: Any) -> None:
        ring = self._ring
        assert ring is not None
        limit_ms = self.value("cloud_age_s") * 1000
        echoes = [
            (k, ring.reading_mm[k] / 1000)
            for k in range(ring.table.sonars)
            if ring.verdicts[k].trusted(self._policy.trust)
            and 0 <= ring.age_ms[k] <= limit_ms
            and ring.limits.is_echo(ring.reading_mm[k] / 1000)
        ]
        self._cloud.publish(messages.cloud(at, self.value("base_link_frame_id"), echoes, ring.table.mounts))

    def _publish_motion(self, motion: Motion, state: dict[str, Any]) -> None:
        at, odom, base = self._now(), self.value("odom_frame_id"), self.value("base_link_frame_id")
        self._odometry.publish(messages.odometry(at, odom, base, motion))
        self._battery.publish(messages.battery(at, base, state["battery_dv"] / 10))
        if self._tf is not None:
            frame = messages.transform(at, odom, base, motion.x_m, motion.y_m, 0.0, motion.heading_rad)
            self._tf.publish(TFMessage(transforms=[frame]))

    def _diagnose(self) -> None:
        if not self._active:
            return
        ring, state = self._ring, self._state
        if ring is None or not state:
            why = self._watcher.why_not if self._watcher is not None else ""
            statuses = [messages.ring_status(OWNER, None, [], "", {"argusd": why})]
        else:
            self._told = ring.verdicts
            statuses = self._statuses(ring, state)
        self._diagnostics.publish(messages.diagnostics(self._now(), statuses))

    def _statuses(self, ring: _Ring, state: dict[str, Any]) -> list[Any]:
        """Return the diagnoses of the ring and of each sonar."""
        hardware = str(state.get("robot") or ring.table.subclass)
        failure = str(state.get("failure", state["state"])) if state.get("online") else None
        keys = ("mode", "mission", "active", "link", "sips", "bad_checksums")
        more = {key: state.get(key, "") for key in keys}
        injected = list(state.get("injected", []))
        more["injected"] = messages.injected_words(injected)
        injected += [""] * (ring.table.sonars - len(injected))
        statuses = [messages.ring_status(OWNER, failure, ring.verdicts, hardware, more)]
        for k in range(ring.table.sonars):
            own = {"injected": injected[k] or "none"}
            verdict, mm, age_ms = ring.verdicts[k], ring.reading_mm[k], ring.age_ms[k]
            statuses.append(messages.sonar_status(OWNER, k, verdict, mm, age_ms, hardware, own))
        return statuses
