# SPDX-License-Identifier: MIT
"""Argus for Foxglove: topics, JSON schemas and messages, the same in an MCAP file and on the live bridge."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any, Final

from hil_sim.tables import robots
from hil_sim.tables.robot import DEFAULT_ROBOT, Mount, own_ring, robot_table

FRAME_ROBOT, FRAME_WORLD = "base_link", "odom"
INFO, WARNING, ERROR = 2, 3, 4  # levels of foxglove.Log
BEAMS, ODOMETRY, TF, STATE, EVENTS, RING = (
    "/sonar/beams",
    "/odometry",
    "/tf",
    "/robot/state",
    "/events",
    "/ring",
)

_NUMBER: Final = {"type": "number"}
_TIME: Final = {
    "type": "object",
    "title": "time",
    "properties": {"sec": {"type": "integer", "minimum": 0}, "nsec": {"type": "integer", "minimum": 0}},
}
_VECTOR: Final = {"type": "object", "properties": {"x": _NUMBER, "y": _NUMBER, "z": _NUMBER}}
_QUATERNION: Final = {
    "type": "object",
    "properties": {"x": _NUMBER, "y": _NUMBER, "z": _NUMBER, "w": _NUMBER},
}
_POSE: Final = {"type": "object", "properties": {"position": _VECTOR, "orientation": _QUATERNION}}


def _schema(title: str, **properties: Any) -> dict[str, Any]:
    return {"title": title, "type": "object", "properties": {"timestamp": _TIME, **properties}}


def _list_of(item: Any) -> dict[str, Any]:
    return {"type": "array", "items": item}


_STRING: Final = {"type": "string"}
_BOOLEAN: Final = {"type": "boolean"}
_INTEGER: Final = {"type": "integer"}
_COLOR: Final = {"type": "object", "properties": {"r": _NUMBER, "g": _NUMBER, "b": _NUMBER, "a": _NUMBER}}
_LINES: Final = {
    "type": "object",
    "properties": {
        "type": _INTEGER,
        "pose": _POSE,
        "thickness": _NUMBER,
        "scale_invariant": _BOOLEAN,
        "points": _list_of(_VECTOR),
        "color": _COLOR,
        "colors": _list_of(_COLOR),
        "indices": _list_of(_INTEGER),
    },
}
_ANY_LIST: Final = {"type": "array"}
_ENTITY: Final = {
    "type": "object",
    "properties": {
        "timestamp": _TIME,
        "frame_id": _STRING,
        "id": _STRING,
        "lifetime": {"type": "object", "properties": {"sec": _INTEGER, "nsec": _INTEGER}},
        "frame_locked": _BOOLEAN,
        "metadata": _list_of({"type": "object", "properties": {"key": _STRING, "value": _STRING}}),
        "lines": _list_of(_LINES),
        **dict.fromkeys(
            ("arrows", "cubes", "spheres", "cylinders", "triangles", "texts", "models"), _ANY_LIST
        ),
    },
}
SCHEMAS: Final = {
    "argus.SonarRange": _schema(
        "argus.SonarRange",
        frame_id=_STRING,
        sonar=_INTEGER,
        range_mm=_INTEGER,
        range_m={"type": "number", "description": "absent when there was no echo"},
        valid={"type": "boolean", "description": "false for no echo or a reading that no sonar can give"},
        field_of_view_rad=_NUMBER,
        min_range_m=_NUMBER,
        max_range_m=_NUMBER,
        pose={
            **_POSE,
            "description": "of the transducer in frame_id; absent for a sonar that the robot lacks",
        },
        age_ms={"type": "integer", "description": "live only: since it was measured"},
        health={"type": "string", "description": "live only"},
        fault={"type": "string", "description": "live only: name of the fault, empty for none"},
    ),
    "foxglove.PoseInFrame": _schema("foxglove.PoseInFrame", frame_id=_STRING, pose=_POSE),
    "argus.RobotState": _schema(
        "argus.RobotState",
        x_mm=_NUMBER,
        y_mm=_NUMBER,
        heading_deg=_NUMBER,
        vel_left_mm_s=_NUMBER,
        vel_right_mm_s=_NUMBER,
        battery_v=_NUMBER,
        stall_left=_BOOLEAN,
        stall_right=_BOOLEAN,
        bumpers_front=_INTEGER,
        bumpers_rear=_INTEGER,
        moving=_BOOLEAN,
        motors=_BOOLEAN,
        flags=_INTEGER,
    ),
    "argus.Ring": _schema(
        "argus.Ring",
        mode=_STRING,
        mission=_STRING,
        failure=_STRING,
        active=_BOOLEAN,
        online=_BOOLEAN,
        trusted={"type": "integer", "description": "sonars without the name of a fault"},
        health=_list_of(_STRING),
        fault=_list_of(_STRING),
        injected=_list_of(_STRING),
        plan_deg=_list_of(_NUMBER),
    ),
    "foxglove.FrameTransform": _schema(
        "foxglove.FrameTransform",
        parent_frame_id=_STRING,
        child_frame_id=_STRING,
        translation=_VECTOR,
        rotation=_QUATERNION,
    ),
    "foxglove.Log": _schema(
        "foxglove.Log", level=_INTEGER, message=_STRING, name=_STRING, file=_STRING, line=_INTEGER
    ),
    "foxglove.SceneUpdate": {
        "title": "foxglove.SceneUpdate",
        "type": "object",
        "properties": {"deletions": _ANY_LIST, "entities": _list_of(_ENTITY)},
    },
}

# Okabe and Ito's colours, which stay apart for the colour-blind; a fault is drawn thicker, too.
_ECHO: Final = {"r": 0.0, "g": 0.45, "b": 0.7, "a": 0.9}
_NOTHING: Final = {"r": 0.6, "g": 0.6, "b": 0.6, "a": 0.3}
_DOUBTED: Final = {"r": 0.9, "g": 0.6, "b": 0.0, "a": 0.9}
_FAULTY: Final = {"r": 0.84, "g": 0.37, "b": 0.0, "a": 1.0}
_THIN_M, _THICK_M = 0.02, 0.05
_LINE_STRIP: Final = 0


class Sonars:
    """The sonars of a robot: where they are, and the limits of their readings."""

    def __init__(self, subclass: str) -> None:
        table = robot_table(subclass)
        self.poses = dict(enumerate(table.mounts))
        self.no_echo_mm = table.no_echo_mm
        self.min_mm = table.min_mm
        self.view_rad = math.radians(table.cone_deg)

    def reading(self, number: int, range_mm: int) -> dict[str, Any]:
        """Return an argus.SonarRange."""
        is_echo = range_mm < self.no_echo_mm
        message: dict[str, Any] = {
            "frame_id": FRAME_ROBOT,
            "sonar": number,
            "range_mm": range_mm,
            "valid": is_echo and range_mm >= self.min_mm,
            "field_of_view_rad": self.view_rad,
            "min_range_m": self.min_mm / 1000,
            "max_range_m": self.no_echo_mm / 1000,
        }
        if is_echo:
            message["range_m"] = range_mm / 1000
        if at := self.poses.get(number):
            message["pose"] = pose(at.x_mm, at.y_mm, at.heading_deg)
        return message

    def beams(
        self,
        stamp: Mapping[str, int],
        readings: Mapping[int, int],
        health: Sequence[str] = (),
        fault: Sequence[str] = (),
    ) -> dict[str, Any]:
        """Return a foxglove.SceneUpdate with a line from each sonar to what it sees, coloured by its health."""
        return {
            "deletions": [],
            "entities": [self._beam(stamp, k, mm, health, fault) for k, mm in readings.items()],
        }

    def _beam(
        self,
        stamp: Mapping[str, int],
        number: int,
        range_mm: int,
        health: Sequence[str],
        fault: Sequence[str],
    ) -> dict[str, Any]:
        is_faulty = number < len(fault) and bool(fault[number])
        is_doubted = number < len(health) and health[number] == "SUSPECT"
        color = _ECHO if range_mm < self.no_echo_mm else _NOTHING
        color = _FAULTY if is_faulty else _DOUBTED if is_doubted else color
        at = self.poses.get(number, Mount(0, 0, 0, 0, "none"))
        line = {
            "type": _LINE_STRIP,
            "pose": pose(at.x_mm, at.y_mm, at.heading_deg),
            "thickness": _THICK_M if is_faulty else _THIN_M,
            "scale_invariant": False,
            "points": [{"x": 0.0, "y": 0.0, "z": 0.0}, {"x": range_mm / 1000, "y": 0.0, "z": 0.0}],
            "color": color,
            "colors": [],
            "indices": [],
        }
        return {
            "timestamp": dict(stamp),
            "frame_id": FRAME_ROBOT,
            "id": f"sonar/{number:02d}",
            "lifetime": {"sec": 0, "nsec": 0},
            "frame_locked": True,
            "metadata": [{"key": "fault", "value": fault[number]}] if is_faulty else [],
            "lines": [line],
            **{
                kind: []
                for kind in ("arrows", "cubes", "spheres", "cylinders", "triangles", "texts", "models")
            },
        }


def sonar_topic(number: int) -> str:
    """Return the topic of a sonar."""
    return f"/sonar/{number:02d}"


TOPICS: Final = {
    BEAMS: "foxglove.SceneUpdate",
    ODOMETRY: "foxglove.PoseInFrame",
    TF: "foxglove.FrameTransform",
    STATE: "argus.RobotState",
    EVENTS: "foxglove.Log",
    RING: "argus.Ring",
    **{sonar_topic(number): "argus.SonarRange" for number in range(robot_table().sonars)},
}
"""All topics of a live robot, with their schemas: those of a P3-DX. A robot with more sonars has more."""


@cache
def sonars_of(subclass: str) -> Sonars:
    """Return the sonars of a robot; of one that is not known, those of a P3-DX."""
    return Sonars(subclass if subclass in robots() or own_ring(subclass) else DEFAULT_ROBOT)


def stamp_of(t_ns: int) -> dict[str, int]:
    """Return a time as a message has it."""
    return {"sec": t_ns // 1_000_000_000, "nsec": t_ns % 1_000_000_000}


def pose(x_mm: float, y_mm: float, heading_deg: float) -> dict[str, Any]:
    """Return a pose in the plane."""
    half = math.radians(heading_deg) / 2
    return {
        "position": {"x": x_mm / 1000, "y": y_mm / 1000, "z": 0.0},
        "orientation": {"x": 0.0, "y": 0.0, "z": math.sin(half), "w": math.cos(half)},
    }


def places(x_mm: float, y_mm: float, heading_deg: float) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return where the robot is as a foxglove.PoseInFrame and as a foxglove.FrameTransform."""
    at = pose(x_mm, y_mm, heading_deg)
    frames = {"parent_frame_id": FRAME_WORLD, "child_frame_id": FRAME_ROBOT}
    return (
        {"frame_id": FRAME_WORLD, "pose": at},
        {**frames, "translation": at["position"], "rotation": at["orientation"]},
    )
