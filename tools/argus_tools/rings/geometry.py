# SPDX-License-Identifier: MIT
"""Where sensors stand on a robot: poses in the plane, the tree of frames, and whose sonars points lie on."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from statistics import median
from typing import Any, Final, NamedTuple

from argus_tools.rings.intake import yaw_of
from hil_sim.tables import robots
from hil_sim.tables.robot import Mount, RobotTable, robot_table

_MM: Final = 1000
BESIDE_MOST_MM: Final = 20.0
"""A point of a driver lies on the axis of its sonar; the figures of drivers and tables differ by some mm."""
APART_MOST_MM: Final = 60.0
TURNED_MOST_DEG: Final = 10.0
_DEPTH_MOST: Final = 16


class Pose(NamedTuple):
    """A place and a bearing in the plane, m and rad."""

    x_m: float = 0.0
    y_m: float = 0.0
    yaw_rad: float = 0.0

    def then(self, other: Pose) -> Pose:
        """Return a pose that is told in this one's frame, in the frame of this one."""
        cos, sin = math.cos(self.yaw_rad), math.sin(self.yaw_rad)
        return Pose(
            self.x_m + cos * other.x_m - sin * other.y_m,
            self.y_m + sin * other.x_m + cos * other.y_m,
            self.yaw_rad + other.yaw_rad,
        )


class Frames:
    """The tree of frames, as far as transforms were seen."""

    def __init__(self) -> None:
        self._parents: dict[str, tuple[str, Pose]] = {}

    def take(self, transform: Any) -> tuple[str, str, Pose]:
        """Take a TransformStamped; return parent, child and the pose of the child."""
        moved = transform.transform
        parent, child = frame_name(transform.header.frame_id), frame_name(transform.child_frame_id)
        pose = Pose(float(moved.translation.x), float(moved.translation.y), yaw_of(moved.rotation))
        self._parents[child] = parent, pose
        return parent, child, pose

    def on_robot(self, frame: str) -> Pose | None:
        """Return where a frame is on the robot's base; None where nothing tells it."""
        name, pose = frame_name(frame), Pose()
        for _ in range(_DEPTH_MOST):
            if is_base(name):
                return pose
            if name not in self._parents:
                return None
            name, step = self._parents[name]
            pose = step.then(pose)
        return None


def frame_name(frame: str) -> str:
    """Return the name of a frame without the slash that ROS 1 put before it."""
    return frame.lstrip("/")


def is_base(frame: str) -> bool:
    """Whether a frame is a robot's base by its usual names."""
    return frame.rpartition("/")[2].endswith(("base_link", "base_footprint", "base"))


def range_of(mount: Mount, x_m: float, y_m: float) -> float:
    """Return how far from its sonar a point of the robot's frame is, m."""
    return math.hypot(x_m * _MM - mount.x_mm, y_m * _MM - mount.y_mm) / _MM


def _beside_mm(mount: Mount, x_m: float, y_m: float) -> float:
    """Return how far beside the axis of a sonar a point is; behind it, how far away."""
    along, across = x_m * _MM - mount.x_mm, y_m * _MM - mount.y_mm
    turn = math.radians(mount.heading_deg)
    ahead = along * math.cos(turn) + across * math.sin(turn)
    return abs(across * math.cos(turn) - along * math.sin(turn)) if ahead >= 0 else math.hypot(along, across)


def whose_points(clouds: Sequence[Mapping[int, tuple[float, float]]]) -> tuple[RobotTable, float] | None:
    """Return the robot on whose sonars' axes these points lie, and how far beside; None: on no known robot's."""
    best: tuple[float, RobotTable] | None = None
    for name in robots():
        table = robot_table(name)
        if any(number >= table.sonars for cloud in clouds for number in cloud):
            continue
        beside = [_beside_mm(table.mounts[n], *point) for cloud in clouds for n, point in cloud.items()]
        middle = median(beside) if beside else math.inf
        if best is None or middle < best[0]:
            best = middle, table
    return (best[1], best[0]) if best and best[0] <= BESIDE_MOST_MM else None


def whose_frames(poses: Mapping[str, Pose]) -> tuple[RobotTable, dict[str, int]] | None:
    """Return the robot that has a sonar at each of these places, and which; None: no known robot has."""
    for name in sorted(robots(), key=lambda name: robot_table(name).sonars):
        table = robot_table(name)
        found = {frame: number for frame, pose in poses.items() for number in _at(table, pose)}
        if len(found) == len(poses) == len(set(found.values())):
            return table, found
    return None


def _at(table: RobotTable, pose: Pose) -> Iterator[int]:
    """Yield the sonar that stands and looks so, if there is one."""
    for number, mount in enumerate(table.mounts):
        apart = math.hypot(pose.x_m * _MM - mount.x_mm, pose.y_m * _MM - mount.y_mm)
        turned = (math.degrees(pose.yaw_rad) - mount.heading_deg + 180) % 360 - 180
        if apart <= APART_MOST_MM and abs(turned) <= TURNED_MOST_DEG:
            yield number
            return
