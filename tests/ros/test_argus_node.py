# SPDX-License-Identifier: MIT
"""Rule: what argusd knows of a robot is on the topics of a ROS driver, and nothing of a sonar that it does not trust;
what a service asks for is done, and who has control of argusd keeps it."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import harness
import pytest
from argus_ros import argus_node
from argus_ros.argus_node import ArgusNode
from argus_ros.repair import Verdict
from argus_tools.control import Client
from diagnostic_msgs.msg import DiagnosticArray
from harness import Argusd
from nav_msgs.msg import Odometry
from nodes import SEATS, Bench
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile
from robots import emulated, minded
from sensor_msgs.msg import BatteryState, PointCloud2, Range
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage

from hil_sim.tables.robot import robot_table
from hil_sim.tables.write import toml_of

ROOT = Path(__file__).resolve().parents[2]
DEAD = 3


class Robot:
    """An emulated robot, argusd, the node and a listener on all its topics."""

    def __init__(
        self,
        folder: Path,
        *simulated: str,
        argusd: tuple[str, ...] = ("--passive",),
        sonars: int = 16,
        **given: Any,
    ) -> None:
        self.sim, address = emulated(folder, *simulated)
        self.argusd, place = minded(folder, address, *argusd)
        self.place = place
        values = {"control": place, **given}
        overrides = [Parameter(key, value=value) for key, value in values.items()]
        self.node = ArgusNode(parameter_overrides=overrides)
        self.node.start()
        self.bench = Bench(self.node)
        for number in range(sonars):
            self.bench.listen(Range, f"sonar/range_{number}")
        for kind, topic in (
            (PointCloud2, "sonar/cloud"),
            (Odometry, "pose"),
            (BatteryState, "battery_state"),
            (DiagnosticArray, "/diagnostics"),
            (TFMessage, "/tf"),
        ):
            self.bench.listen(kind, topic)
        self.bench.listen(
            TFMessage, "/tf_static", QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        )

    def await_(self, topic: str, good: Any = lambda _: True, limit_s: float = 60) -> Any:
        """The next message on a topic of which something holds."""
        at = len(self.bench.heard)
        found: list[Any] = []

        def probe() -> bool:
            nonlocal at
            for heard, message in self.bench.heard[at:]:
                at += 1
                if heard == topic and good(message):
                    found.append(message)
                    return True
            return False

        assert self.bench.until(probe, limit_s), f"nothing of that kind on {topic}"
        return found[0]

    def call(self, kind: Any, name: str, **request: Any) -> Any:
        """Call a service of the node."""
        client = self.bench.listener.create_client(kind, name)
        assert self.bench.until(client.service_is_ready)
        future = client.call_async(kind.Request(**request))
        assert self.bench.until(future.done)
        return future.result()

    def close(self) -> None:
        self.bench.close()
        self.node.destroy_node()
        self.argusd.end()
        self.sim.end()


@pytest.fixture
def robot(tmp_path: Path) -> Iterator[Any]:
    made: list[Robot] = []

    def make(*simulated: str, **given: Any) -> Robot:
        made.append(Robot(tmp_path, *simulated, **given))
        return made[-1]

    yield make
    for one in made:
        one.close()


def status_of(array: Any, name: str) -> Any:
    return next(status for status in array.status if status.name == name)


def values_of(status: Any) -> dict[str, str]:
    return {value.key: value.value for value in status.values}


@pytest.mark.parametrize("kind", ["known", "own ring"])
def test_every_sonar_of_a_ring_of_more_than_sixteen_has_its_topics(
    robot: Any, kind: str, tmp_path: Path
) -> None:
    ring = str(tmp_path / "scitos.toml")
    Path(ring).write_text(toml_of(robot_table(str(ROOT / "docs/samples/rings/scitos-g5.toml"))))
    own = kind == "own ring"
    sonars, last = (24, "sonar/upper_front/23") if own else (32, "sonar/upper_rear/31")
    bot = robot(
        "--world", "demo", *(("--ring", ring) if own else ("--robot", "peoplebot-sh")),
        argusd=("--passive", *(("--ring", ring) if own else ())),
        sonars=sonars,
        robot=ring if own else "",
    )  # fmt: skip
    for number in (0, sonars - 1):
        assert bot.await_(f"sonar/range_{number}").header.frame_id == f"sonar_{number}"
    health = bot.await_("/diagnostics", lambda m: len(m.status) > sonars)
    assert any(status.name.endswith(last) for status in health.status), [s.name for s in health.status]
    assert bot.await_("sonar/cloud").width <= sonars
    assert bot.bench.until(lambda: any(topic == "/tf_static" for topic, _ in bot.bench.heard))
    static = next(message for topic, message in bot.bench.heard if topic == "/tf_static")
    assert len(static.transforms) == sonars
    assert bot.call(Trigger, f"sonar/retest_{sonars - 1}").success


def test_a_state_may_list_fewer_sonars_than_the_ring_has() -> None:
    """Before it knows the robot argusd lists sixteen."""
    ring = argus_node._Ring(robot_table("peoplebot-sh"))
    ring.take_state({"health": ["HEALTHY"] * 16, "kind": ["none"] * 16})
    ring.take_readings({"t": 1.0, "mm": [700] * 16, "age_ms": [20] * 16})
    assert ring.verdicts == [Verdict("HEALTHY", "none")] * 16 + [Verdict()] * 16
    assert (ring.reading_mm, ring.age_ms) == ([700] * 16 + [-1] * 16, [20] * 16 + [-1] * 16)
    ring.take_readings({"t": 1.0, "mm": [700] * 40, "age_ms": [20] * 40})
    assert len(ring.reading_mm) == len(ring.age_ms) == 32


def test_topics_tell_what_argusd_knows(robot: Any) -> None:
    bot = robot("--world", "demo", "--fault", f"stuck:{DEAD}@3s:value=0")
    truth = harness.wait_for(
        "a reading of each", lambda: [e for e in bot.argusd.named("STATUS") if e["sips"] > 5], 60
    )[-1]
    echo = bot.await_("sonar/range_0", lambda m: math.isfinite(m.range))
    assert abs(echo.range - truth["reading_mm"][0] / 1000) < 0.1
    assert (echo.header.frame_id, echo.radiation_type) == ("sonar_0", Range.ULTRASOUND)
    assert (round(echo.min_range, 3), echo.max_range, round(echo.field_of_view, 4)) == (0.1, 5.0, 0.5236)
    assert bot.await_("battery_state").voltage == pytest.approx(truth["battery_dv"] / 10)
    place = bot.await_("pose")
    assert (place.header.frame_id, place.child_frame_id) == ("odom", "base_link")
    assert abs(place.pose.pose.position.x) < 0.01
    assert bot.bench.until(lambda: any(topic == "/tf_static" for topic, _ in bot.bench.heard))
    static = next(message for topic, message in bot.bench.heard if topic == "/tf_static")
    frames = {transform.child_frame_id: transform for transform in static.transforms}
    assert len(frames) == 16
    seat, there = SEATS[5], frames["sonar_5"].transform
    assert (there.translation.x, there.translation.y) == pytest.approx((seat.x, seat.y))
    assert 2 * math.atan2(there.rotation.z, there.rotation.w) == pytest.approx(seat.yaw)
    assert bot.await_("/tf").transforms[0].child_frame_id == "base_link"
    # The sonar that is stuck: named in the diagnoses, and silent on its topic and in the cloud from then on.
    name = f"argus: sonar/front/{DEAD:02d}"
    said = bot.await_("/diagnostics", lambda m: len(m.status) > 1 and status_of(m, name).level == b"\x02")
    assert status_of(said, name).message == "DISABLED stuck"
    assert values_of(status_of(said, "argus: ring"))["not_trusted"] == str(DEAD)
    assert status_of(said, "argus: ring").level == b"\x01"
    bot.bench.take()
    for _ in range(12):
        cloud = bot.await_("sonar/cloud")
        points = list(struct.iter_unpack("<fffBxxx", bytes(cloud.data)))
        assert points
        assert DEAD not in {number for *_, number in points}
    heard = {topic for topic, _ in bot.bench.heard}
    assert f"sonar/range_{DEAD}" not in heard
    assert "sonar/range_2" in heard


def test_what_argusd_injects_is_told_of_the_sonar_and_of_the_ring(robot: Any) -> None:
    bot = robot("--world", "demo", argusd=("--passive", "--inject"))
    bot.await_("pose")
    with Client(bot.place) as argus:
        argus.take()
        for number, kind in ((DEAD, "off"), (9, "stuck")):
            argus.order("fail", sonar=number, kind=kind, for_ms=60_000)

    def told(array: Any) -> bool:
        ring = next(status for status in array.status if status.name == "argus: ring")
        return values_of(ring).get("injected") == f"{DEAD}: off, 9: stuck"

    said = bot.await_("/diagnostics", told)
    each = [values_of(status)["injected"] for status in said.status if "sonar/" in status.name]
    assert each == ["off" if k == DEAD else "stuck" if k == 9 else "none" for k in range(16)]


def test_no_echo_is_infinite_and_a_dead_sonar_is_what_the_parameter_says(robot: Any) -> None:
    bot = robot("--world", "hall", "--fault", f"stuck:{DEAD}@2s:value=0", dead="invalid")
    assert bot.await_("sonar/range_4").range == math.inf
    assert math.isnan(bot.await_(f"sonar/range_{DEAD}", lambda m: math.isnan(m.range)).range)


def test_services_do_what_they_say_and_leave_control_to_who_has_it(robot: Any) -> None:
    bot = robot("--world", "demo")
    bot.await_("pose")
    assert bot.call(SetBool, "sonar/pin_5", data=True).success
    bot.argusd.wait("SONAR_PINNED", name="sonar/front/05")
    assert bot.call(SetBool, "sonar/pin_5", data=False).success
    assert bot.call(Trigger, "sonar/recheck").success
    assert bot.call(Trigger, "sonar/retest_2").success
    assert bot.call(SetBool, "passive", data=False).success
    bot.argusd.wait("STATUS", active=True)
    assert bot.call(SetBool, "passive", data=True).success
    with Client(bot.place) as other:
        other.take()
        refused = bot.call(Trigger, "sonar/recheck")
        assert not refused.success
        assert "control" in refused.message
        other.order("recheck")


def test_argusd_that_goes_away_is_said_and_found_again(robot: Any) -> None:
    bot = robot("--world", "demo")
    bot.await_("pose")
    bot.argusd.end()
    gone = bot.await_("/diagnostics", lambda m: "argus.sock" in values_of(m.status[0]).get("argusd", ""))
    assert gone.status[0].level == b"\x03"
    bot.argusd = Argusd([*bot.argusd.command[1:]])
    bot.bench.take()
    bot.await_("pose")


def test_a_lifecycle_manager_can_hold_it_back(robot: Any) -> None:
    bot = robot("--world", "demo", autostart=False)
    assert not bot.bench.until(lambda: bool(bot.bench.heard), 1.5)
    bot.node.trigger_configure()
    assert not bot.bench.until(lambda: any(topic == "pose" for topic, _ in bot.bench.heard), 1.5)
    bot.node.trigger_activate()
    bot.await_("pose")
    bot.node.trigger_deactivate()
    bot.bench.take()
    assert not bot.bench.until(lambda: any(topic == "pose" for topic, _ in bot.bench.heard), 1.0)
    bot.node.trigger_cleanup()
    bot.node.trigger_configure()
    bot.node.trigger_activate()
    bot.await_("pose")
