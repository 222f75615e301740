# SPDX-License-Identifier: MIT
"""Rule: a silent loss of function is a diagnosis, what others send is taken, run-time changes work, and two robots in
one graph are told apart."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from argus_ros.argus_node import ArgusNode
from argus_ros.guard_node import RangeGuard
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import Twist, TwistStamped
from harness import ROOT, Argusd
from nodes import Bench
from rclpy.context import Context
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile, ReliabilityPolicy
from robots import emulated, free_port, minded
from sensor_msgs.msg import Range
from test_argus_node import Robot
from test_cmd_vel import Driven
from test_programs import commands_of, running

OLD_RUNS_S = 12.0
BEST_EFFORT = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


@pytest.fixture
def driven(tmp_path: Path) -> Iterator[Any]:
    made: list[Driven] = []

    def make(**given: Any) -> Driven:
        made.append(Driven(tmp_path, **given))
        made[-1].bench.listen(DiagnosticArray, "/diagnostics")
        return made[-1]

    yield make
    for one in made:
        one.close()


def send(robot: Driven, kind: Any, seconds: float, qos: Any = 1, age_s: float | None = 0.0) -> float:
    """Order 0.2 m/s for a while by the robot's clock, as a type; return the greatest true speed meanwhile."""
    context = Context()  # another participant: one has each topic as one type only
    context.init()
    sender = Node("sender", context=context)
    publisher = sender.create_publisher(kind, "cmd_vel", qos)
    assert robot.bench.until(lambda: bool(publisher.get_subscription_count()))
    begin = robot.sim.t_s
    while robot.sim.t_s < begin + seconds:
        message = kind()
        if kind is TwistStamped and age_s is not None:
            now = robot.bench.listener.get_clock().now().nanoseconds - round(age_s * 1e9)
            message.header.stamp.sec, message.header.stamp.nanosec = divmod(now, 1_000_000_000)
        (message.twist if kind is TwistStamped else message).linear.x = 0.2
        publisher.publish(message)
        robot.spin(0.1)
    sender.destroy_node()
    context.shutdown()
    return float(max(state["v_mm_s"] for state in robot.sim.of("state", begin)))


@pytest.mark.parametrize(
    ("kind", "qos", "age_s"),
    [(TwistStamped, 1, 0.0), (TwistStamped, BEST_EFFORT, None), (Twist, BEST_EFFORT, None)],
)
def test_cmd_vel_is_taken_as_either_type_and_from_any_publisher(
    driven: Any, kind: Any, qos: Any, age_s: float | None
) -> None:
    robot = driven()
    assert send(robot, kind, 2.5, qos, age_s) > 150
    robot.sim.wait_rest()


def last_of(robot: Driven, name: str) -> Any:
    """The status of a name as it was last published; an empty one before that."""
    said = [m for topic, m in robot.bench.heard if topic == "/diagnostics"]
    found = [status for status in said[-1].status if status.name == name] if said else []
    return found[0] if found else DiagnosticStatus()


def test_a_stale_order_moves_nothing_and_is_reported(driven: Any) -> None:
    robot = driven()
    assert send(robot, TwistStamped, 2, age_s=5.0) < 20
    assert robot.bench.until(lambda: "older" in last_of(robot, "argus: cmd_vel").message)
    assert last_of(robot, "argus: cmd_vel").level == b"\x01"


def test_cmd_vel_of_a_foreign_type_is_reported(driven: Any) -> None:
    robot = driven()
    robot.node._taken["cmd_vel"] = (
        "geometry_msgs/msg/Pose"  # so that the Twist of this test is the foreign one
    )
    foreign = "published as geometry_msgs/msg/Twist"
    assert robot.bench.until(lambda: foreign in last_of(robot, "argus: cmd_vel").message)
    assert last_of(robot, "argus: topics").level == b"\x01"


def test_argusd_that_is_restarted_is_followed_at_once(tmp_path: Path) -> None:
    bot = Robot(tmp_path, "--world", "demo")
    try:
        bot.await_("sonar/range_0")
        bot.bench.until(lambda: False, OLD_RUNS_S)
        bot.argusd.end()
        bot.argusd = Argusd([*bot.argusd.command[1:]])
        bot.await_("/diagnostics", lambda m: m.status[0].level == b"\x03")
        bot.await_("/diagnostics", lambda m: m.status[0].level == b"\x00")
        bot.bench.take()
        begin_s = bot.sim.t_s
        for number in range(16):
            bot.await_(f"sonar/range_{number}")
        # The mistake was to wait until the new one has run for as long as the old one had.
        assert bot.sim.t_s - begin_s < OLD_RUNS_S
    finally:
        bot.close()


def stamps_of(bot: Robot) -> list[float]:
    """When what was heard of the diagnostics was published, s."""
    stamps = [m.header.stamp for topic, m in bot.bench.heard if topic == "/diagnostics"]
    return [stamp.sec + stamp.nanosec / 1e9 for stamp in stamps]


def test_what_is_set_at_run_time_works_and_nonsense_is_refused(tmp_path: Path) -> None:
    bot = Robot(tmp_path, "--world", "hall")
    try:
        assert bot.await_("sonar/range_4").range == math.inf

        def put(key: str, value: Any) -> bool:
            return bool(bot.node.set_parameters([Parameter(key, value=value)])[0].successful)

        assert put("no_echo", "max")
        bot.bench.take()
        assert bot.await_("sonar/range_4").range == 5.0
        assert put("diagnostics_s", 0.2)
        bot.bench.take()
        assert bot.bench.until(lambda: len(stamps_of(bot)) >= 9)
        gaps_s = [later - earlier for earlier, later in pairwise(stamps_of(bot))]
        assert min(gaps_s) < 0.5, gaps_s
        refused = [
            *[("max_speed_m_s", v) for v in (-1.0, math.nan, math.inf, 99.0)],
            ("no_echo", "loud"),
            ("diagnostics_s", 0.0),
            ("period_ms", 200),  # read when the node is configured
            ("autostart", False),
        ]
        assert [pair for pair in refused if put(*pair)] == []
        assert bot.node.describe_parameter("period_ms").integer_range[0].from_value == 50
        assert bot.node.describe_parameter("autostart").read_only
        bot.node.trigger_deactivate()
        bot.node.trigger_cleanup()
        assert put("period_ms", 200)
    finally:
        bot.close()


def test_a_namespace_is_in_names_frames_and_the_place_of_argusd(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ARGUS_CONTROL", raising=False)
    node, guard = ArgusNode(namespace="robot7"), RangeGuard(namespace="robot7")
    plain = ArgusNode(parameter_overrides=[Parameter("frame_prefix", value="x_")])
    for one in (node, guard, plain):
        one.trigger_configure()
    assert (node.owner, guard.owner, plain.owner) == ("robot7/argus", "robot7/range_guard", "argus")
    assert node._place == "unix:/run/argus/robot7/control"
    assert plain._place == "unix:/run/argus/control"
    assert node.frame("odom_frame_id") == "robot7/odom"
    assert guard.frame("base_frame") == "robot7/base_link"
    assert plain.frame("base_link_frame_id") == "x_base_link"
    for one in (node, guard, plain):
        one.destroy_node()


def test_the_launch_file_of_two_robots_tells_them_apart(tmp_path: Path) -> None:
    ends: list[Any] = []
    given: dict[str, str] = {}
    for number in (1, 2):
        folder = tmp_path / str(number)
        folder.mkdir()
        sim, address = emulated(folder, "--world", "demo")
        port = free_port()
        argusd, place = minded(folder, address, "--passive", "--guard", f"tcp:127.0.0.1:{port}")
        given |= {f"control_{number}": place, f"guard_{number}": f"127.0.0.1:{port}"}
        ends += [argusd, sim]
    first, second = commands_of(ROOT / "tools/argus_ros/launch/two_robots.launch.xml", **given)
    bench = Bench()
    for number in (1, 2):
        bench.listen(Range, f"/robot{number}/sonar/range_0")
    bench.listen(DiagnosticArray, "/diagnostics")
    try:
        with running(first), running(second):

            def both() -> bool:
                names = {s.name for t, m in bench.heard if t == "/diagnostics" for s in m.status}
                frames = {m.header.frame_id for t, m in bench.heard if t != "/diagnostics"}
                wanted = {f"robot{n}/argus: sonar/front/00" for n in (1, 2)}
                return wanted <= names and frames == {"robot1/sonar_0", "robot2/sonar_0"}

            assert bench.until(both, 60)
    finally:
        bench.close()
        for one in ends:
            one.end()
