# SPDX-License-Identifier: MIT
"""Writes a small ROS 1 bag as RosAria would: a P3-DX drives through a room, and sonar 5 gets stuck after 10 s."""

from __future__ import annotations

import math
import sys

import numpy as np
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_typestore

SONARS = [  # x and y in m, bearing in degrees
    (0.069, 0.136, 90), (0.114, 0.119, 50), (0.148, 0.078, 30), (0.166, 0.027, 10),
    (0.166, -0.027, -10), (0.148, -0.078, -30), (0.114, -0.119, -50), (0.069, -0.136, -90),
]  # fmt: skip
WALLS = ((-2.0, 9.0), (-2.2, 1.7))  # of the room, in x and in y
SPEED, START, NO_ECHO, STUCK, STUCK_FROM = 0.25, 1_700_000_000, 5.0, 5, 10.0

store = get_typestore(Stores.ROS1_NOETIC)
types = store.types
rng = np.random.default_rng(1)


def heard(x: float, y: float, heading: float, sonar: int) -> float:
    """Return how far the nearest wall in a sonar's cone is."""
    sx, sy, bearing = SONARS[sonar]
    cos, sin = math.cos(heading), math.sin(heading)
    place = (x + cos * sx - sin * sy, y + sin * sx + cos * sy)
    nearest = NO_ECHO
    for beam in range(-15, 16, 3):
        turn = heading + math.radians(bearing + beam)
        for axis, way in enumerate((math.cos(turn), math.sin(turn))):
            for wall in WALLS[axis]:
                if abs(way) > 0.2 and (wall - place[axis]) / way > 0:
                    nearest = min(nearest, (wall - place[axis]) / way)
    return nearest if nearest == NO_ECHO else nearest + float(rng.normal(0, 0.002))


def header(t: float, frame: str) -> object:
    """Return a header of a time after the start."""
    stamp = types["builtin_interfaces/msg/Time"](START + int(t), int(t % 1 * 1e9))
    return types["std_msgs/msg/Header"](0, stamp, frame)


def main(path: str) -> None:
    """Write the bag."""
    vector, point = types["geometry_msgs/msg/Vector3"], types["geometry_msgs/msg/Point32"]
    x = y = 0.0
    with Writer(path) as bag:
        pose_topic = bag.add_connection("/RosAria/pose", "nav_msgs/msg/Odometry", typestore=store)
        sonar_topic = bag.add_connection("/RosAria/sonar", "sensor_msgs/msg/PointCloud", typestore=store)
        for n in range(300):
            t = n / 10
            heading, turn = 0.25 * math.sin(t / 3), math.cos(t / 3) / 12
            place = types["geometry_msgs/msg/Point"](x, y, 0.0)
            facing = types["geometry_msgs/msg/Quaternion"](
                0.0, 0.0, math.sin(heading / 2), math.cos(heading / 2)
            )
            pose = types["geometry_msgs/msg/PoseWithCovariance"](
                types["geometry_msgs/msg/Pose"](place, facing), np.zeros(36)
            )
            twist = types["geometry_msgs/msg/Twist"](vector(SPEED, 0.0, 0.0), vector(0.0, 0.0, turn))
            moved = types["geometry_msgs/msg/TwistWithCovariance"](twist, np.zeros(36))
            odometry = types["nav_msgs/msg/Odometry"](header(t, "odom"), "base_link", pose, moved)
            ranges = [heard(x, y, heading, k) for k in range(8)]
            if t > STUCK_FROM:
                ranges[STUCK] = 0.7
            points = [
                point(
                    sx + range_m * math.cos(math.radians(deg)),
                    sy + range_m * math.sin(math.radians(deg)),
                    0.0,
                )
                for (sx, sy, deg), range_m in zip(SONARS, ranges, strict=True)
            ] + [point(0.0, 0.0, 0.0)] * 8  # the rear array that this robot lacks
            cloud = types["sensor_msgs/msg/PointCloud"](header(t, "sonar_frame"), points, [])
            at = int((START + t) * 1e9)
            bag.write(pose_topic, at, store.serialize_ros1(odometry, "nav_msgs/msg/Odometry"))
            bag.write(sonar_topic, at, store.serialize_ros1(cloud, "sensor_msgs/msg/PointCloud"))
            x, y = x + SPEED * 0.1 * math.cos(heading), y + SPEED * 0.1 * math.sin(heading)


if __name__ == "__main__":
    main(sys.argv[1])
