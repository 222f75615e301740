# SPDX-License-Identifier: MIT
"""Small bags as real drivers record them, by rosbags' writers: a robot that drives along a wall past a box."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.interfaces import Nodetype
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from hil_sim.tables.robot import robot_table

TABLE = robot_table("p3dx-sh")
START = 1_700_000_000.0
SONAR_ARRAY = "p2os_msgs/msg/SonarArray"
NO_ECHO_MM = 5000.0
ROOM = ((-2000.0, 9000.0), (-2200.0, 1700.0))
"""Its walls, mm: in x and in y."""
SPEED_MM_S = 250.0


Place = tuple[float, float]


@dataclass
class Sent:
    """One message: topic, type, the recorder's time in s, and its fields as a tree; `stamp` for its header."""

    topic: str
    type: str
    t: float
    fields: dict[str, Any]
    stamp: float | None = None
    frame: str = ""


@dataclass
class Drive:
    """What each sonar truly hears, at each 100 ms: time, place in mm, heading in rad, and ranges in mm."""

    seed: int = 1
    seconds: float = 20.0
    dead: tuple[int, ...] = ()
    steps: list[tuple[float, Place, float, list[float]]] = field(default_factory=list)

    def __post_init__(self) -> None:
        rng = random.Random(self.seed)
        x = y = 0.0
        for n in range(int(self.seconds * 10)):
            t = n * 0.1
            heading = 0.25 * math.sin(t / 3)
            ranges = [
                NO_ECHO_MM if k in self.dead else self._heard((x, y), heading, k, rng)
                for k in range(TABLE.sonars)
            ]
            self.steps.append((START + t, (x, y), heading, ranges))
            middle = 0.25 * math.sin((t + 0.05) / 3)
            x += SPEED_MM_S * 0.1 * math.cos(middle)
            y += SPEED_MM_S * 0.1 * math.sin(middle)

    def _heard(self, place: Place, heading: float, k: int, rng: random.Random) -> float:
        mount = TABLE.mounts[k]
        cos, sin = math.cos(heading), math.sin(heading)
        at = (place[0] + cos * mount.x_mm - sin * mount.y_mm, place[1] + sin * mount.x_mm + cos * mount.y_mm)
        nearest = NO_ECHO_MM
        for step in range(-15, 16, 3):
            turn = heading + math.radians(mount.heading_deg + step)
            for axis, way in enumerate((math.cos(turn), math.sin(turn))):
                for wall in ROOM[axis]:
                    if abs(way) > 0.2 and (far := (wall - at[axis]) / way) > 0:
                        nearest = min(nearest, far)
        return NO_ECHO_MM if nearest > NO_ECHO_MM - 50 else max(150.0, nearest + rng.gauss(0, 2))


def _header(sent: Sent, is_first: bool) -> dict[str, Any]:
    stamp = sent.t if sent.stamp is None else sent.stamp
    sec = math.floor(stamp)
    header: dict[str, Any] = {
        "stamp": {"sec": sec, "nanosec": round((stamp - sec) * 1e9)},
        "frame_id": sent.frame,
    }
    return {"seq": 0, **header} if is_first else header


def odometry(t: float, place: Place, heading: float, topic: str = "/pose", **more: Any) -> Sent:
    half = heading / 2
    pose = {
        "position": {"x": place[0] / 1000, "y": place[1] / 1000, "z": 0.0},
        "orientation": _quaternion(half),
    }
    twist = {
        "linear": {"x": SPEED_MM_S / 1000, "y": 0.0, "z": 0.0},
        "angular": {"x": 0.0, "y": 0.0, "z": math.cos((t - START) / 3) / 12},
    }
    fields = {
        "child_frame_id": "base_link",
        "pose": {"pose": pose, "covariance": np.zeros(36)},
        "twist": {"twist": twist, "covariance": np.zeros(36)},
    }
    return Sent(topic, "nav_msgs/msg/Odometry", t, fields, frame="odom", **more)


def _quaternion(half: float) -> dict[str, float]:
    return {"x": 0.0, "y": 0.0, "z": math.sin(half), "w": math.cos(half)}


def transform(
    t: float, child: str, parent: str, x_m: float, y_m: float, yaw: float, topic: str = "/tf"
) -> Sent:
    moved = {"translation": {"x": x_m, "y": y_m, "z": 0.0}, "rotation": _quaternion(yaw / 2)}
    inner = Sent(topic, "", t, {}, frame=parent)
    one = {"header": inner, "child_frame_id": child, "transform": moved}
    return Sent(topic, "tf2_msgs/msg/TFMessage", t, {"transforms": [one]})


def points(
    ranges: Iterable[float], absent: Callable[[int], bool] = lambda k: k >= 8
) -> Iterator[tuple[float, float]]:
    for k, range_mm in enumerate(ranges):
        mount, turn = TABLE.mounts[k], math.radians(TABLE.mounts[k].heading_deg)
        if absent(k):
            yield 0.0, 0.0
        else:
            yield (
                (mount.x_mm + range_mm * math.cos(turn)) / 1000,
                (mount.y_mm + range_mm * math.sin(turn)) / 1000,
            )


def cloud(t: float, ranges: Iterable[float], topic: str = "/sonar", **more: Any) -> Sent:
    fields = {"points": [{"x": x, "y": y, "z": 0.0} for x, y in points(ranges)], "channels": []}
    return Sent(topic, "sensor_msgs/msg/PointCloud", t, fields, frame="base_link", **more)


def cloud2(t: float, ranges: Iterable[float], topic: str = "/sonar2") -> Sent:
    data = np.array([(x, y, 0.0) for x, y in points(ranges)], dtype="<f4").tobytes()
    names = [{"name": name, "offset": 4 * n, "datatype": 7, "count": 1} for n, name in enumerate("xyz")]
    fields = {
        "height": 1, "width": len(data) // 12, "fields": names, "is_bigendian": False, "point_step": 12,
        "row_step": len(data), "data": np.frombuffer(data, dtype=np.uint8), "is_dense": True,
    }  # fmt: skip
    return Sent(topic, "sensor_msgs/msg/PointCloud2", t, fields, frame="base_link")


def array(t: float, ranges_m: Iterable[float], topic: str = "/sonar") -> Sent:
    values = np.array(list(ranges_m), dtype=np.float64)
    return Sent(topic, SONAR_ARRAY, t, {"ranges_count": len(values), "ranges": values})


def single(
    t: float, k: int, range_m: float, topic: str, frame: str, greatest_m: float = 5.0, **more: Any
) -> Sent:
    fields = {
        "radiation_type": 0, "field_of_view": 0.5, "min_range": 0.1, "max_range": greatest_m, "range": range_m,
        "variance": 0.0,
    }  # fmt: skip
    return Sent(topic, "sensor_msgs/msg/Range", t, fields, frame=frame, **more)


def scan(t: float, place: Place, heading: float, topic: str = "/scan", frame: str = "laser") -> Sent:
    angles = np.radians(np.arange(-120.0, 121.0))
    ranges = np.full(len(angles), np.inf)
    for n, angle in enumerate(angles):
        turn = heading + angle
        for axis, way in enumerate((math.cos(turn), math.sin(turn))):
            for wall in ROOM[axis]:
                if abs(way) > 1e-9 and (far := (wall - place[axis]) / way) > 0:
                    ranges[n] = min(ranges[n], far / 1000)
    fields = {
        "angle_min": float(angles[0]), "angle_max": float(angles[-1]), "angle_increment": math.radians(1),
        "time_increment": 0.0, "scan_time": 0.1, "range_min": 0.05, "range_max": 30.0,
        "ranges": ranges.astype(np.float32), "intensities": np.empty(0, dtype=np.float32),
    }  # fmt: skip
    return Sent(topic, "sensor_msgs/msg/LaserScan", t, fields, frame=frame)


def write(path: Path, sent: Iterable[Sent], storage: str = "ros1") -> Path:
    """Write a bag: ros1, sqlite3 or mcap; the latter two into the folder `path`."""
    is_first = storage == "ros1"
    store = get_typestore(Stores.ROS1_NOETIC if is_first else Stores.ROS2_HUMBLE)
    text = "std_msgs/Header header\nint32 ranges_count\nfloat64[] ranges\n"
    store.register(get_types_from_msg(text, SONAR_ARRAY))
    if is_first:
        store.register(
            get_types_from_msg("geometry_msgs/TransformStamped[] transforms\n", "tf2_msgs/msg/TFMessage")
        )
    if is_first:
        writer: Any = Writer1(path)
    else:
        kind = StoragePlugin.MCAP if storage == "mcap" else StoragePlugin.SQLITE3
        writer = Writer2(path, version=9, storage_plugin=kind)
    serialize = store.serialize_ros1 if is_first else store.serialize_cdr
    topics: dict[str, Any] = {}
    with writer as bag:
        for one in sent:
            if one.topic not in topics:
                topics[one.topic] = bag.add_connection(one.topic, one.type, typestore=store)
            body = _made(store, one.type, one, is_first)
            bag.write(topics[one.topic], round(one.t * 1e9), serialize(body, one.type))
    return path


def _made(store: Any, kind: str, value: Any, is_first: bool) -> Any:
    """Return a message of a tree of fields."""
    if isinstance(value, Sent):
        is_header = kind == "std_msgs/msg/Header"
        value = _header(value, is_first) if is_header else {"header": value, **value.fields}
    made = {}
    for name, (node, described) in store.fielddefs[kind][1]:
        given = value[name]
        if node == Nodetype.NAME:
            made[name] = _made(store, described, given, is_first)
        elif isinstance(given, list):
            made[name] = [_made(store, described[0][1], one, is_first) for one in given]
        else:
            made[name] = given
    return store.types[kind](**made)
