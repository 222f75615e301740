# SPDX-License-Identifier: MIT
"""Which topics of a recording are the ring and the odometry of one robot, and how their messages are to be read."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import islice
from typing import Final

from argus_tools.chunks import LogError
from argus_tools.rings.geometry import Frames, frame_name, is_base
from argus_tools.rings.intake import Odd, motion_of
from argus_tools.rings.motion import Motion
from argus_tools.rings.recording import Broken, Message, Recording, Topic
from argus_tools.rings.sensors import (
    ARRAYS,
    CLOUD,
    CLOUD2,
    POINTS_MOST,
    RANGE,
    SCAN,
    Array,
    Both,
    Cloud,
    Readings,
    Scan,
    Sectors,
    Sensors,
    Singles,
    points_of,
)
from argus_tools.rings.silence import Silence
from hil_sim.tables.robot import DEFAULT_ROBOT, RobotTable, robot_table

ODOMETRY: Final = "nav_msgs/msg/Odometry"
TF: Final = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")
KINDS: Final = ((CLOUD, CLOUD2), ARRAYS, (RANGE,), (SCAN,))
"""In the order in which they are preferred: a scan is taken where no sonar was recorded."""
SURVEYED: Final = 3000
"""So many messages tell what a ring's readings look like."""
_POINTS_SEEN: Final = 5


@dataclass
class Plan:
    """What was chosen and found."""

    table: RobotTable
    sensors: Sensors
    silence: Silence
    topics: list[str]
    odometry: str | None
    transforms: list[str]
    frames: Frames
    present: frozenset[int]
    """The sonars that are in a message at all."""
    first: list[Message]
    """Messages of its beginning."""
    words: list[str] = field(default_factory=list)

    def millimetres(self, readings: Readings) -> dict[int, int | None]:
        """Return readings as the fault manager takes them, in mm; what stands for no echo is of the sonars alone."""
        sectors, far = frozenset(self.table.sectors), self.table.no_echo_mm
        return {
            number: (min(round(range_m * 1000), far) if range_m * 1000 < far else far)
            if number in sectors
            else self.silence.millimetres(range_m)
            for number, range_m in readings.items()
        }


def planned(recording: Recording, name: str, topic: str | None, robot: str | None) -> Plan:
    """Return how a recording is read; LogError where it has no ring. topic, robot: what the user asks for."""
    given = robot_table(robot) if robot else None
    chosen, others = _topics(recording, name, topic, given)
    transforms = [one.name for one in recording.topics if one.type in TF and one.count]
    odometry = _odometry(recording.topics, chosen)
    frames, seen = _survey(recording, chosen, transforms)
    if not seen:
        raise LogError(f"{name}: no message of {', '.join(one.name for one in chosen)} can be read")
    default = robot_table(robot or DEFAULT_ROBOT)
    sensors = _with_laser(seen, given, frames, default)
    silence = Silence(sensors.table.no_echo_mm, sensors.table.min_mm, sensors.greatest_m)
    present: set[int] = set()
    for message in seen:
        try:
            for number, range_m in sensors.take(message).items():
                present.add(number)
                if number not in sensors.table.sectors:
                    silence.note(number, range_m)
        except Odd:
            continue
    no_echo = silence.settle()
    if len(sensors.table.sectors) == sensors.table.sonars:
        no_echo = (
            f"no return is {sensors.table.no_echo_mm / 1000:.3f} m or more, or outside of the scan's limits"
        )
    names = [one.name for one in chosen]
    plan = Plan(
        sensors.table, sensors, silence, names, odometry, transforms, frames, frozenset(present), seen
    )
    count = sum(one.count for one in chosen)
    which = chosen[0].name if len(chosen) == 1 else f"{len(chosen)} topics"
    if len(chosen) == 2 and chosen[1].type == SCAN != chosen[0].type:
        which = f"{chosen[0].name} and {chosen[1].name}"
    plan.words.append(f"ranges: {which} ({chosen[0].type}, {count} messages), ring of {plan.table.subclass}")
    plan.words += sensors.words()
    plan.words.append(no_echo)
    plan.words += _pose_words(plan)
    if others:
        plan.words.append(f"not read: {', '.join(others)}; --topic chooses")
    return plan


def _topics(
    recording: Recording, name: str, asked: str | None, table: RobotTable | None
) -> tuple[list[Topic], list[str]]:
    """Return the topics of one ring, the scan of its laser last, and the names of those that are not read."""
    scans = [one for one in recording.topics if one.type == SCAN and one.count]
    alone = table is not None and len(table.sectors) == table.sonars
    if alone and not scans:
        raise LogError(f"{name}: no scan of a laser (LaserScan) in it, and the ring is a laser alone")
    if table is None or not table.sectors or not scans:
        return _ring_topics(recording, name, asked)
    scans.sort(key=lambda one: (not one.name.startswith(asked or ""), -one.count, one.name))
    others = [one.name for one in scans[1:]]
    if alone:
        return scans[:1], others
    chosen, beside = _ring_topics(recording, name, None if asked == scans[0].name else asked)
    if chosen[0].type == SCAN:
        return scans[:1], others
    return [*chosen, scans[0]], beside + others


def _ring_topics(recording: Recording, name: str, asked: str | None) -> tuple[list[Topic], list[str]]:
    """Return the topics of one ring, and the names of those that another ring has."""
    here = [one for one in recording.topics if one.count and (asked is None or one.name.startswith(asked))]
    exact = [one for one in here if one.name == asked]
    found: list[list[Topic]] = []
    for kinds in KINDS:
        of_kind = [one for one in exact or here if one.type in kinds]
        if kinds == (RANGE,):
            found += [of_kind] if of_kind else []
        else:
            of_kind.sort(key=lambda one: (kinds.index(one.type), -one.count, one.name))
            found += [[one] for one in of_kind if one.type not in (CLOUD, CLOUD2) or _is_ring(recording, one)]
    if not found:
        types = Counter(one.type for one in recording.topics if one.count)
        has = ", ".join(sorted(types)[:8]) or "nothing"
        of = f" of {asked}" if asked else ""
        raise LogError(
            f"{name}: no ranges of sonars{of} (Range, PointCloud with a point a sonar, SonarArray, LaserScan) in it; "
            f"it holds {has}"
        )
    if found[0][0].type != SCAN:
        found = [one for one in found if one[0].type != SCAN]
    chosen = found[0]
    others = {_namespace(one[0].name): one[0].name for one in reversed(found[1:])}
    others.pop(_namespace(chosen[0].name), None)
    return chosen, sorted(others.values())


def _namespace(topic: str) -> str:
    return topic.rpartition("/")[0]


def _is_ring(recording: Recording, topic: Topic) -> bool:
    try:
        sizes = [
            len(points_of(message)) for message in islice(recording.messages([topic.name]), _POINTS_SEEN)
        ]
    except (Broken, Odd, ValueError):
        return False
    return 0 < max(sizes, default=0) <= POINTS_MOST


def _odometry(topics: Sequence[Topic], chosen: Sequence[Topic]) -> str | None:
    """Return the odometry whose name has most in common with the ring's."""
    found = [one for one in topics if one.type == ODOMETRY and one.count]
    best = max(found, key=lambda one: (_alike(one.name, chosen[0].name), one.count), default=None)
    return best.name if best else None


def _alike(one: str, other: str) -> int:
    """Return how many components two topics begin with in common."""
    pairs = zip(one.split("/"), other.split("/"), strict=False)
    return next((n for n, (a, b) in enumerate(pairs) if a != b), 0)


def _survey(
    recording: Recording, chosen: Sequence[Topic], transforms: Sequence[str]
) -> tuple[Frames, list[Message]]:
    """Return the tree of frames and the first messages of the ring."""
    frames, seen = Frames(), []
    ring = {one.name for one in chosen}
    try:
        for message in recording.messages([*ring, *transforms]):
            if message.topic in ring:
                seen.append(message)
                if len(seen) >= (SURVEYED if message.type != SCAN else SURVEYED // 10):
                    break
                continue
            for transform in message.body.transforms:
                try:
                    frames.take(transform)
                except Odd:
                    continue
    except Broken:
        pass  # reported when the messages are read
    return frames, seen


def _with_laser(
    seen: list[Message], table: RobotTable | None, frames: Frames, default: RobotTable
) -> Sensors:
    """Return what reads the messages: a scan as sectors where the ring has a laser."""
    scans = [message for message in seen if message.type == SCAN]
    if table is None or not table.sectors or not scans:
        return _sensors(seen, table, frames, default)
    laser = Sectors(scans, table, frames)
    sonars = [message for message in seen if message.type != SCAN]
    return Both(_sensors(sonars, table, frames, default), laser) if sonars else laser


def _sensors(seen: list[Message], table: RobotTable | None, frames: Frames, default: RobotTable) -> Sensors:
    kind = seen[0].type
    if kind in (CLOUD, CLOUD2):
        return Cloud(seen, table, frames)
    if kind == RANGE:
        return Singles(seen, table, frames, default)
    if kind == SCAN:
        return Scan(seen, default, frames)
    return Array(seen, default)


def _pose_words(plan: Plan) -> list[str]:
    if plan.odometry:
        return [f"pose: {plan.odometry}"]
    if plan.transforms:
        return [f"pose: transforms of a robot's base in {', '.join(plan.transforms)}"]
    return ["no odometry in it: the robot is taken to be at rest, where nothing can be cross-checked"]


class Place:
    """Where the robot is, of its odometry, or of transforms where there is none."""

    SPEED_SPAN_S: Final = 0.05

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._ring = plan.topics[0]
        self._t = 0.0
        self._pair: tuple[str, str] | None = None
        self.motion = Motion()

    def take(self, message: Message) -> None:
        """Take an odometry message or transforms."""
        if message.topic == self._plan.odometry:
            self.motion, self._t = motion_of(message.body), message.t
            return
        for transform in message.body.transforms:
            parent, child, pose = self._plan.frames.take(transform)
            if self._plan.odometry or not is_base(child) or not self._is_ours(parent, child):
                continue
            passed_s = message.t - self._t
            if self._pair is None or passed_s >= self.SPEED_SPAN_S:
                place = Motion(pose.x_m, pose.y_m, pose.yaw_rad)
                self.motion = place.since(self.motion, passed_s) if self._pair else place
                self._pair, self._t = (parent, child), message.t

    def _is_ours(self, parent: str, child: str) -> bool:
        if self._pair is not None:
            return self._pair == (parent, child)
        prefix = child.rpartition("/")[0]
        return is_odom(parent) and (not prefix or prefix in self._ring)

    def at(self, t: float) -> Motion:
        """Return where the robot is at a time, by its last speeds."""
        return self.motion.after(t - self._t)


def is_odom(frame: str) -> bool:
    """Whether a frame is one that odometry moves in, by its usual name."""
    return "odom" in frame_name(frame).rpartition("/")[2]
