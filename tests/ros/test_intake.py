# SPDX-License-Identifier: MIT
"""Rule: a bad message ends no guard: it is discarded, counted and reported in /diagnostics, its sonar not trusted; the
ring is never OK while readings are not judged."""

from __future__ import annotations

import math
import random
import struct
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from argus_ros import messages
from argus_ros.guard_node import RangeGuard
from argus_ros.intake import UNFORESEEN
from argus_ros.timeline import Pace, Timeline
from argus_tools.rings.intake import Limits, Odd
from argus_tools.rings.motion import Motion
from builtin_interfaces.msg import Time
from nav_msgs.msg import Odometry
from rclpy.parameter import Parameter
from sensor_msgs.msg import Range

VIEW_RAD = 0.5
BEGIN_S = 1_700_000_000.0
PERIOD_S = 0.1
OK, WARN, ERROR, STALE = (bytes((level,)) for level in range(4))


def stamped(t_s: float) -> Time:
    return Time(sec=int(t_s), nanosec=round(t_s % 1 * 1e9) % 1_000_000_000)


class Fed:
    """A guard whose callbacks are called as the executor would, on a steady clock of the test's own."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, **given: Any) -> None:
        self.steady_s = 1000.0
        monkeypatch.setattr(time, "monotonic", lambda: self.steady_s)
        self.node = RangeGuard(parameter_overrides=[Parameter(k, value=v) for k, v in given.items()])
        self.takes: dict[str, Callable[[Any], None]] = {}
        self.said: dict[str, list[Any]] = {}
        subscribe, publish = self.node.take_topic, self.node.publisher

        def take_topic(kind: Any, topic: str, take: Callable[[Any], None], qos: Any) -> None:
            self.takes[topic] = take
            subscribe(kind, topic, take, qos)

        def publisher(kind: Any, topic: str, qos: Any = 10) -> Any:
            made = publish(kind, topic, qos)
            monkeypatch.setattr(made, "publish", self.said.setdefault(topic, []).append)
            return made

        monkeypatch.setattr(self.node, "take_topic", take_topic)
        monkeypatch.setattr(self.node, "publisher", publisher)
        self.node.start()
        self.t_s = BEGIN_S

    def range(self, k: int, value: float = 1.0, at_s: float | None = None, **fields: Any) -> None:
        at = stamped(self.t_s if at_s is None else at_s)
        message = messages.range_message(at, f"sonar_{k}", value, Limits(0.1, 5.0), VIEW_RAD)
        for key, field in fields.items():
            setattr(message, key, field)
        self.takes[f"sonar/range_{k}"](message)

    def pose(self, change: Callable[[Any], None] = lambda _: None) -> None:
        message = messages.odometry(stamped(self.t_s), "odom", "base_link", Motion())
        change(message)
        self.takes["pose"](message)

    def step(self, odd: Callable[[int], dict[str, Any]] = lambda _: {}, pose: bool = True) -> None:
        """A tenth of a second of a driver; `odd`: what differs in the reading of a sonar."""
        self.steady_s += PERIOD_S
        self.t_s += PERIOD_S
        if pose:
            self.pose()
        for k in range(16):
            self.range(k, **{"value": 1.0 + k / 10 + self.t_s % 0.02, **odd(k)})
        self.node._tick()

    def status(self, name: str) -> Any:
        self.node._diagnose()
        return next(s for s in self.said["/diagnostics"][-1].status if s.name == f"range_guard: {name}")

    def ring(self) -> Any:
        return self.status("ring")


@pytest.fixture
def fed(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    made: list[Fed] = []

    def make(**given: Any) -> Fed:
        made.append(Fed(monkeypatch, **given))
        return made[-1]

    yield make
    for one in made:
        one.node.destroy_node()


def run(one: Fed, seconds: float, **how: Any) -> None:
    for _ in range(round(seconds / PERIOD_S)):
        one.step(**how)


def test_a_sound_driver_is_ok(fed: Any) -> None:
    one = fed()
    assert one.ring().level == STALE
    run(one, 4)
    assert (one.ring().level, one.ring().message) == (OK, "16 of 16 sonars to be trusted")


def spoil(path: str, value: float) -> Callable[[Any], None]:
    def change(message: Any) -> None:
        *way, last = path.split(".")
        for name in way:
            message = getattr(message, name)
        setattr(message, last, value)

    return change


@pytest.mark.parametrize(
    ("path", "value"),
    [
        *((f"pose.pose.position.{axis}", math.nan) for axis in "xy"),
        *((f"pose.pose.orientation.{axis}", math.nan) for axis in "xyzw"),
        ("pose.pose.orientation.w", 0.0),
        ("pose.pose.orientation.w", 40.0),
        ("pose.pose.position.x", math.inf),
        ("pose.pose.position.y", 1e300),
        ("twist.twist.linear.x", 450.0),
        ("twist.twist.linear.x", -math.inf),
        ("twist.twist.angular.z", math.nan),
        ("twist.twist.angular.z", 1e9),
        ("header.stamp.sec", -5),
        ("header.stamp.nanosec", 4_000_000_000),
    ],
)
def test_odd_odometry_is_discarded_and_reported(fed: Any, path: str, value: float) -> None:
    one = fed()
    run(one, 3)
    before = one.node._ring.motion
    one.t_s += 0.01
    one.pose(spoil(path, value))
    assert one.node._ring.motion is before
    ring = one.ring()
    assert ring.level == WARN
    assert "odometry discarded" in ring.message
    assert {v.key: v.value for v in ring.values}["discarded"] == "1"
    run(one, 1)
    assert one.ring().level == OK


@pytest.mark.parametrize(
    "odd",
    [
        {"max_range": 0.0},
        {"max_range": math.nan, "value": math.inf},
        {"max_range": 5000.0, "min_range": 100.0, "value": 1500.0},  # all in millimetres
        {"value": 1500.0},
        {"value": 150.0},
        {"value": -1.0},
        {"min_range": math.inf},
        {"min_range": 6.0},
        {"field_of_view": math.nan},
        {"field_of_view": 30.0},
    ],
)
def test_a_sonar_whose_readings_do_not_hold_is_not_trusted(fed: Any, odd: dict[str, Any]) -> None:
    one = fed()
    run(one, 3)
    for messages_ in one.said.values():
        messages_.clear()
    run(one, 2, odd=lambda k: odd if k in (3, 9) else {})
    assert one.said["sonar/range_3/guarded"] == []
    assert len(one.said["sonar/range_2/guarded"]) == 20
    sensors = {p[3] for cloud in one.said["sonar/cloud_guarded"][8:] for p in points(cloud)}
    assert sensors == set(range(16)) - {3, 9}
    status = one.status("sonar/front/03")
    assert status.level == ERROR
    assert status.message.startswith("discarded: ")
    assert one.ring().level != OK
    assert "sonars 3 9" in one.ring().message
    run(one, 1)
    assert not one.status("sonar/front/03").message.startswith("discarded")


def points(cloud: Any) -> list[Any]:
    return list(struct.iter_unpack("<fffBxxx", bytes(cloud.data)))


def test_all_in_millimetres_leaves_nothing_judged(fed: Any) -> None:
    one = fed()
    run(one, 3, odd=lambda k: {"value": 1000.0 + k})
    assert one.ring().level == STALE
    assert "metres" in one.ring().message


def test_a_newer_range_message_keeps_its_fields(fed: Any) -> None:
    # Those of PyPI are so new already; in an older installation there is no such field to keep.
    assert "variance" in Range.get_fields_and_field_types()
    one = fed()
    one.step(odd=lambda k: {"variance": 0.25, "radiation_type": Range.INFRARED})
    (said,) = one.said["sonar/range_4/guarded"]
    assert (said.variance, said.radiation_type, said.header.frame_id) == (0.25, Range.INFRARED, "sonar_4")


@pytest.mark.parametrize("away_s", [3600.0, -3600.0, 1.5, -1.5, -1.6e9])
def test_two_topics_on_another_clock_are_reported_and_the_others_judged(fed: Any, away_s: float) -> None:
    one = fed()
    run(
        one, 8, odd=lambda k: {"at_s": one.t_s + away_s} if k in (0, 11) else {"value": 0.0} if k == 5 else {}
    )
    assert one.node._ring.restarts <= 1
    ring = one.ring()
    assert ring.level != OK
    assert "sonars 0 11" in ring.message
    assert "another clock" in one.status("sonar/front/00").message
    assert one.status("sonar/front/05").message == "DISABLED stuck"


def test_every_topic_on_a_clock_of_its_own_is_never_ok(fed: Any) -> None:
    one = fed()
    for _ in range(60):
        one.step(odd=lambda k: {"at_s": one.t_s + 100 * k})
        assert one.ring().level != OK


def test_a_clock_that_jumps_all_the_time_is_never_ok(fed: Any) -> None:
    one, chance = fed(), random.Random(7)
    for _ in range(60):
        one.t_s = BEGIN_S + chance.uniform(0, 1e6)
        one.step()
        assert one.ring().level != OK


@pytest.mark.parametrize("back_s", [1.5, 4.0, 30.0])
def test_a_bag_that_is_looped_starts_anew(fed: Any, back_s: float) -> None:
    one = fed()
    for _ in range(round(back_s / PERIOD_S)):
        one.step()
    run(one, 1)
    one.t_s = BEGIN_S
    run(one, 8, odd=lambda k: {"value": 0.0} if k == 3 else {})
    assert one.node._ring.restarts == 1
    assert one.status("sonar/front/03").message == "DISABLED stuck"


@pytest.mark.parametrize("gap_s", [0.9, 1.5, 4.0])
def test_a_pause_is_no_jump(fed: Any, gap_s: float) -> None:
    one = fed()
    run(one, 3)
    one.t_s += gap_s
    one.steady_s += gap_s
    run(one, 2)
    assert one.node._ring.restarts == 0
    if gap_s < 2:  # for longer a sonar that does not report is silent
        assert len(one.said["sonar/range_3/guarded"]) == 50


def test_silence_is_seen_within_two_seconds(fed: Any) -> None:
    one = fed()
    run(one, 4)
    assert one.ring().level == OK
    one.said["/diagnostics"].clear()
    end = one.steady_s + 2
    while one.steady_s < end:
        one.steady_s += 0.1
        one.node._tick()
    assert one.said["/diagnostics"][-1].status[0].level == STALE
    assert one.ring().message == "no readings come"


def test_no_odometry_is_reported(fed: Any) -> None:
    one = fed()
    run(one, 3, pose=False)
    assert (one.ring().level, "no odometry" in one.ring().message) == (WARN, True)
    run(one, 3)
    assert one.ring().level == OK
    run(one, 3, pose=False)
    assert "odometry comes no more" in one.ring().message


def test_a_part_that_falls_silent_is_reported(fed: Any) -> None:
    one = fed(topics=["a", "b", "c"], sonars=[1, 3, 6])
    for _ in range(40):
        one.t_s += PERIOD_S
        one.steady_s += PERIOD_S
        one.pose()
        for topic in "ab":
            message = messages.range_message(stamped(one.t_s), topic, 1.0, Limits(0.1, 5.0), VIEW_RAD)
            one.takes[topic](message)
        one.node._tick()
    assert one.ring().level == WARN
    assert one.ring().message.startswith("2 of 3 sonars")


def test_no_stamp_before_the_first_clock_is_discarded(fed: Any) -> None:
    one = fed(use_sim_time=True)
    one.range(3, at_s=0.0)
    assert one.said["sonar/range_3/guarded"] == []
    assert "/clock" in one.ring().message


def test_diagnosis_that_is_off_is_never_ok(fed: Any) -> None:
    one = fed(settings=["diagnosis=off"])
    run(one, 4)
    assert one.ring().level == WARN
    assert "diagnosis is off" in one.ring().message


@pytest.mark.parametrize("period_s", [0.0999, 0.1, 0.1001])
@pytest.mark.parametrize("jitter_s", [0.0, 0.02, 0.04])
def test_a_cloud_with_each_packet(period_s: float, jitter_s: float) -> None:
    chance, pace = random.Random(3), Pace()
    packets = [k * period_s + chance.uniform(-jitter_s, jitter_s) for k in range(1000)]
    due = sum(pace.is_due(BEGIN_S + t_s + sonar * 1e-3) for t_s in packets for sonar in range(16))
    assert due >= 9.9 * 1000 * min(period_s, 0.1)


def test_a_steady_stream_has_ten_clouds_a_second() -> None:
    pace = Pace()
    assert 1000 <= sum(pace.is_due(k / 137) for k in range(13_700)) <= 1002


def test_time_never_goes_back_within_a_clock() -> None:
    chance, line = random.Random(11), Timeline()
    for k in range(5000):
        before, jumps = line.now_s, line.jumps
        at_s = k / 100 + chance.choice([0.0, 0.0, -0.3, 2.0, -50.0, 1e6])
        try:
            taken = line.take(f"t{chance.randrange(5)}", at_s, None, k / 100)
        except Odd:
            continue
        assert line.jumps != before or line.now_s >= before or line.jumps > jumps
        assert all(abs(s - line.now_s) <= 1.0 for _, s, _ in taken)


ODD_FLOATS = (math.nan, math.inf, -math.inf, 0.0, -0.0, 1e-300, 1e38, -1e38, 450.0, 1500.0, -1.0, 5.0, 0.1)


def random_float(chance: random.Random) -> float:
    if chance.random() < 0.5:
        return chance.choice(ODD_FLOATS)
    return float(struct.unpack("<f", struct.pack("<I", chance.getrandbits(32)))[0])


def random_stamp(chance: random.Random, t_s: float) -> Time:
    if chance.random() < 0.7:
        return stamped(t_s + chance.choice([0.0, 0.0, 0.0, -0.2, 3.0, -3.0, 1e4]))
    return Time(sec=chance.randrange(-(1 << 31), 1 << 31), nanosec=chance.getrandbits(32))


def spoiled(message: Any, chance: random.Random, paths: tuple[str, ...]) -> Any:
    for path in paths:
        if chance.random() < 0.3:
            spoil(path, random_float(chance))(message)
    return message


RANGE_FIELDS = ("range", "min_range", "max_range", "field_of_view", "variance")
POSE_FIELDS = (
    *(f"pose.pose.position.{axis}" for axis in "xyz"),
    *(f"pose.pose.orientation.{axis}" for axis in "xyzw"),
    *(f"twist.twist.linear.{axis}" for axis in "xyz"),
    *(f"twist.twist.angular.{axis}" for axis in "xyz"),
)


def storm(one: Fed, count: int, seed: int) -> None:
    """Random messages on all topics that the guard takes; nothing of it raises, or says what nobody measured."""
    print(f"seed {seed}")
    chance = random.Random(seed)
    for k in range(count):
        one.t_s += 0.005
        one.steady_s += 0.005
        if chance.random() < 0.1:
            odometry = spoiled(Odometry(), chance, POSE_FIELDS)
            odometry.header.stamp = random_stamp(chance, one.t_s)
            one.takes["pose"](odometry)
        else:
            number = chance.randrange(16)
            reading = messages.range_message(stamped(one.t_s), "s", 1.0, Limits(0.1, 5.0), VIEW_RAD)
            spoiled(reading, chance, RANGE_FIELDS)
            reading.header.stamp = random_stamp(chance, one.t_s)
            one.takes[f"sonar/range_{number}"](reading)
        if k % 100 == 0:
            one.node._tick()
            for topic, said in one.said.items():
                if topic.endswith("/guarded"):
                    assert all(
                        m.min_range <= m.range <= m.max_range or not math.isfinite(m.range) for m in said
                    )
                if topic != "/diagnostics":
                    said.clear()
            for array in one.said["/diagnostics"]:
                assert array.status[0].level != OK, array.status[0].message
            one.said["/diagnostics"].clear()
    reasons = {why for counts in one.node._intake.counts.values() for why in counts}
    assert not [why for why in reasons if why.startswith(UNFORESEEN)]
    assert one.node._intake.discarded() > count / 4


@pytest.mark.parametrize("seed", [1, 2])
def test_random_messages_end_no_guard(fed: Any, seed: int) -> None:
    storm(fed(dead="cover"), 4000, seed)


@pytest.mark.soak
@pytest.mark.parametrize("dead", ["withhold", "cover"])
def test_a_million_random_messages_end_no_guard(fed: Any, dead: str) -> None:
    storm(fed(dead=dead), 500_000, 3)
