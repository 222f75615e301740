# SPDX-License-Identifier: MIT
"""Messages of range finders as readings of a ring's sonars, one class for each kind of message."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any, Final, Protocol

import numpy as np
import numpy.typing as npt

from argus_tools.chunks import LogError
from argus_tools.rings.geometry import Frames, Pose, frame_name, range_of, whose_frames, whose_points
from argus_tools.rings.intake import Odd, limits_of
from argus_tools.rings.recording import SONAR_ARRAY, Message
from hil_sim.laser.scan import Beams
from hil_sim.tables.robot import RobotTable

RANGE: Final = "sensor_msgs/msg/Range"
SCAN: Final = "sensor_msgs/msg/LaserScan"
CLOUD: Final = "sensor_msgs/msg/PointCloud"
CLOUD2: Final = "sensor_msgs/msg/PointCloud2"
ARRAYS: Final = (SONAR_ARRAY, "p2os_msg/msg/SonarArray", "p2os_driver/msg/SonarArray")
"""p2os for ROS 2, for ROS 1, and its older driver."""
POINTS_MOST: Final = 32
"""A cloud of more points is no ring of sonars."""
CONE_DEG: Final = 15.0
_FLOATS: Final = {7: "f4", 8: "f8"}

Readings = dict[int, float]


class Sensors(Protocol):
    """Readings of sonars, m; inf is no echo, NaN none. One that is absent from the robot is in no reading."""

    table: RobotTable
    greatest_m: float | None
    is_array: bool
    """Whether a message has all of them, and not one."""

    def words(self) -> list[str]:
        """Return what was found, a line each."""

    def take(self, message: Message) -> Readings:
        """Return the readings of a message; Odd for one that is discarded."""


def points_of(message: Message) -> list[tuple[float, float]]:
    """Return the points of a PointCloud or PointCloud2, x and y in m."""
    body = message.body
    if message.type == CLOUD:
        return [(float(point.x), float(point.y)) for point in body.points]
    fields = {field.name: field for field in body.fields}
    if not {"x", "y"} <= fields.keys() or any(fields[name].datatype not in _FLOATS for name in "xy"):
        raise Odd("cloud has no x and y")
    order = ">" if body.is_bigendian else "<"
    kind = np.dtype(
        {
            "names": ["x", "y"],
            "formats": [order + _FLOATS[fields[name].datatype] for name in "xy"],
            "offsets": [fields[name].offset for name in "xy"],
            "itemsize": body.point_step,
        }
    )
    points = np.frombuffer(bytes(body.data), kind, count=body.width * body.height)
    return [(float(x), float(y)) for x, y in points]


class Cloud:
    """One point a sonar in the robot's frame. A point that is (0, 0) all the time is no sonar."""

    is_array = True
    greatest_m: float | None = None

    def __init__(self, seen: Sequence[Message], table: RobotTable | None, frames: Frames) -> None:
        self._frame = frames.on_robot(seen[0].body.header.frame_id) or Pose()
        clouds = [dict(enumerate(self._points(message))) for message in seen]
        size = max(map(len, clouds))
        self._absent = frozenset(
            n for n in range(size) if all(_is_nothing(cloud[n]) for cloud in clouds if n in cloud)
        )
        present = [
            {
                n: point
                for n, point in cloud.items()
                if n not in self._absent and all(map(math.isfinite, point))
            }
            for cloud in clouds
        ]
        if not any(present):
            raise LogError("all points of the cloud are (0, 0, 0): no sonar is there")
        found: tuple[RobotTable, float | None] | None = (table, None) if table else whose_points(present)
        if found is None:
            raise LogError(
                "the points lie on the axes of no known robot's sonars; --subclass names the robot"
            )
        self.table, self._beside_mm = found
        if size > self.table.sonars and set(range(self.table.sonars, size)) - self._absent:
            raise LogError(
                f"a cloud of {size} points, but {self.table.subclass} has {self.table.sonars} sonars"
            )

    def words(self) -> list[str]:
        """Return what was found."""
        told = []
        if self._beside_mm is not None:
            told.append(
                f"points lie on the axes of the sonars of {self.table.subclass}, to {self._beside_mm:.0f} mm"
            )
        if self._absent:
            told.append(
                f"{len(self._absent)} points are (0, 0, 0) throughout: no sonars ({_numbers(self._absent)})"
            )
        return told

    def _points(self, message: Message) -> Iterator[tuple[float, float]]:
        for x_m, y_m in points_of(message):
            if _is_nothing((x_m, y_m)):
                yield x_m, y_m
            else:
                pose = self._frame.then(Pose(x_m, y_m))
                yield pose.x_m, pose.y_m

    def take(self, message: Message) -> Readings:
        """Return how far each point is from its sonar."""
        found: Readings = {}
        for number, point in enumerate(self._points(message)):
            if number in self._absent or number >= self.table.sonars:
                continue
            if _is_nothing(point) or any(map(math.isnan, point)):
                found[number] = math.nan
            else:
                found[number] = range_of(self.table.mounts[number], *point)
        return found


def _is_nothing(point: tuple[float, float]) -> bool:
    return point == (0.0, 0.0)


def _numbers(found: frozenset[int]) -> str:
    return ", ".join(map(str, sorted(found)))


class Array:
    """Ranges in a list, as p2os and p2os2 publish them."""

    is_array = True
    greatest_m: float | None = None

    def __init__(self, seen: Sequence[Message], table: RobotTable) -> None:
        self.table = table
        size = max(len(message.body.ranges) for message in seen)
        if size > table.sonars:
            raise LogError(
                f"a list of {size} ranges, but {table.subclass} has {table.sonars} sonars; "
                "--subclass names another robot"
            )

    def words(self) -> list[str]:
        """Return what was found: nothing that was not known."""
        return []

    def take(self, message: Message) -> Readings:
        """Return the ranges as they are."""
        return {number: float(range_m) for number, range_m in enumerate(message.body.ranges)}


class Singles:
    """One Range message a sonar, told apart by topic and frame. Frames of the tree or numbers in names say which."""

    is_array = False

    def __init__(
        self, seen: Sequence[Message], table: RobotTable | None, frames: Frames, default: RobotTable
    ) -> None:
        keys = sorted({_key(message) for message in seen}, key=_natural)
        limits = [message.body.max_range for message in seen if math.isfinite(message.body.max_range)]
        self.greatest_m: float | None = max(map(float, limits), default=None)
        poses = {
            f"{topic} {frame}": pose for topic, frame in keys if (pose := frames.on_robot(frame)) is not None
        }
        placed = whose_frames(poses) if len(poses) == len(keys) and table is None else None
        self.table = placed[0] if placed else table or default
        if len(keys) > self.table.sonars:
            raise LogError(
                f"{len(keys)} topics of ranges, but {self.table.subclass} has {self.table.sonars} sonars; "
                "give --topic with what their names begin with, or another robot by --subclass"
            )
        self._is_placed = placed is not None
        if placed:
            self._sonars = {key: placed[1][f"{key[0]} {key[1]}"] for key in keys}
        else:
            self._sonars = dict(zip(keys, _by_number(keys, self.table.sonars), strict=True))

    def words(self) -> list[str]:
        """Return which topic was taken for which sonar."""
        how = "where their frames are" if self._is_placed else "the numbers and order of their names"
        pairs = [f"{topic} = {number}" for (topic, _), number in self._sonars.items()]
        some = ", ".join(pairs[:3]) + (", ..." if len(pairs) > 3 else "")
        what = "1 topic is a sonar" if len(pairs) == 1 else f"{len(pairs)} topics are sonars"
        return [f"{what} of {self.table.subclass} by {how}: {some}"]

    def take(self, message: Message) -> Readings:
        """Return the one reading."""
        limits, number = limits_of(message.body), self._sonars.get(_key(message))
        if number is None:
            raise Odd("frame that came late is not used")
        range_m = float(message.body.range)
        if math.isfinite(range_m) and range_m >= limits.greatest_m * (1 - 1e-6):
            range_m = math.inf
        return {number: range_m}


def _key(message: Message) -> tuple[str, str]:
    return message.topic, frame_name(message.body.header.frame_id)


def _natural(key: tuple[str, str]) -> tuple[list[tuple[int, str]], ...]:
    """Return what sorts names by the numbers in them."""
    return tuple([(int(part), "") if part.isdigit() else (-1, part) for part in _parts(text)] for text in key)


def _parts(text: str) -> list[str]:
    found: list[str] = []
    for letter in text:
        if found and found[-1][-1].isdigit() == letter.isdigit():
            found[-1] += letter
        else:
            found.append(letter)
    return found


def _by_number(keys: Sequence[tuple[str, str]], sonars: int) -> list[int]:
    """Return the last number in each name where these are sonars of the robot, from 0 or from 1; else the order."""
    for at in (0, 1):
        last = [[int(part) for part in _parts(key[at]) if part.isdigit()][-1:] for key in keys]
        if all(last):
            numbers = [one[0] for one in last]
            if len(set(numbers)) == len(numbers) and max(numbers) <= sonars:
                first = (
                    1 if max(numbers) == sonars or (min(numbers) == 1 and max(numbers) == len(numbers)) else 0
                )
                if min(numbers) >= first:
                    return [number - first for number in numbers]
    return list(range(len(keys)))


class Scan:
    """A laser's scan as the robot's sonars would hear it: the nearest return within each cone."""

    is_array = True

    def __init__(self, seen: Sequence[Message], table: RobotTable, frames: Frames) -> None:
        self.table = table
        self.greatest_m: float | None = None
        body = seen[0].body
        pose = frames.on_robot(body.header.frame_id)
        self._is_placed = pose is not None
        self._pose = pose or Pose()
        self._form: tuple[float, float, int] | None = None
        self._angles: npt.NDArray[Any] = np.empty(0)
        self._shape(body)
        ends = self._angles + self._pose.yaw_rad
        self._covered = [
            n for n, mount in enumerate(table.mounts) if _sees(ends, math.radians(mount.heading_deg))
        ]
        if not self._covered:
            raise LogError("the scan covers the bearing of no sonar of the robot")

    def words(self) -> list[str]:
        """Return what is made of the scan."""
        where = (
            "" if self._is_placed else "; no transform says where the laser is, so it is taken at the centre"
        )
        return [
            f"the scan is read as sonars {_numbers(frozenset(self._covered))} of {self.table.subclass}{where}"
        ]

    def _shape(self, body: Any) -> None:
        form = (float(body.angle_min), float(body.angle_increment), len(body.ranges))
        if form != self._form:
            self._form = form
            self._angles = form[0] + form[1] * np.arange(form[2])

    def take(self, message: Message) -> Readings:
        """Return the nearest return in each cone."""
        body = message.body
        self._shape(body)
        ranges = np.asarray(body.ranges, dtype=np.float64)
        is_echo = (ranges >= body.range_min) & (ranges < body.range_max) & (ranges > 0)
        far, turn = ranges[is_echo], self._angles[is_echo] + self._pose.yaw_rad
        x_mm: npt.NDArray[Any] = (self._pose.x_m + far * np.cos(turn)) * 1000
        y_mm: npt.NDArray[Any] = (self._pose.y_m + far * np.sin(turn)) * 1000
        found: Readings = {}
        for number in self._covered:
            mount = self.table.mounts[number]
            along, across = x_mm - mount.x_mm, y_mm - mount.y_mm
            off: npt.NDArray[Any] = np.arctan2(across, along) - math.radians(mount.heading_deg)
            beside = np.abs(np.arctan2(np.sin(off), np.cos(off)))
            seen = np.hypot(along, across)[beside <= math.radians(CONE_DEG)]
            found[number] = float(seen.min()) / 1000 if seen.size else math.inf
        return found


class Sectors:
    """A laser's scan as the ring's sectors: the nearest return in each."""

    is_array = True
    greatest_m: float | None = None

    def __init__(self, seen: Sequence[Message], table: RobotTable, frames: Frames) -> None:
        self.table = table
        pose = frames.on_robot(seen[0].body.header.frame_id)
        self._is_placed = pose is not None
        self._yaw = pose.yaw_rad if pose else 0.0
        self._form: tuple[float, float, int] | None = None
        if not self.take(seen[0]):
            raise LogError(
                f"the scan looks into no sector of {table.subclass}: [laser] facing_deg, field_deg"
            )

    def words(self) -> list[str]:
        """Return what is made of the scan."""
        where = (
            ""
            if self._is_placed
            else "; no transform says whither the laser looks, so it is taken to look ahead"
        )
        return [
            f"the scan is read as {len(self.table.sectors)} sectors of {self.table.sector_deg} degrees{where}"
        ]

    def take(self, message: Message) -> Readings:
        """Return the nearest return in each sector, m; inf: nothing returned."""
        body = message.body
        ranges = np.asarray(body.ranges, dtype=np.float64)
        if not (math.isfinite(body.angle_min) and math.isfinite(body.angle_increment)):
            raise Odd("angles of the scan are not finite")
        form = (float(body.angle_min), float(body.angle_increment), len(ranges))
        if form != self._form:
            self._form = form
            self._beams = Beams(
                self.table, self._yaw + form[0] + form[1] * np.arange(form[2], dtype=np.float64)
            )
        is_return = (ranges >= body.range_min) & (ranges < body.range_max) & (ranges > 0)
        return self._beams.nearest(np.where(is_return, ranges, np.inf))


class Both:
    """Sonars and a laser beside them, each from messages of its own."""

    is_array = True

    def __init__(self, sonars: Sensors, laser: Sectors) -> None:
        self.table, self.greatest_m = sonars.table, sonars.greatest_m
        self._sonars, self._laser = sonars, laser

    def words(self) -> list[str]:
        """Return what was found of both."""
        return self._sonars.words() + self._laser.words()

    def take(self, message: Message) -> Readings:
        """Return the readings of a message of either."""
        return (self._laser if message.type == SCAN else self._sonars).take(message)


def _sees(angles: npt.NDArray[np.float64], bearing: float) -> bool:
    apart = np.arctan2(np.sin(angles - bearing), np.cos(angles - bearing))
    return bool(angles.size) and float(np.abs(apart).min()) < math.radians(1.0)
