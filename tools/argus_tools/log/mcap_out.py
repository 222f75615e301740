# SPDX-License-Identifier: MIT
"""A log as MCAP with JSON schemas: one channel per sonar, odometry, robot state and events, for Foxglove."""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Iterator
from typing import Any, Final

from mcap.writer import Writer

from argus_tools.log.fields import Decoder
from argus_tools.log.packets import Row
from hil_sim.tables import load

_SONAR: Final[dict[str, Any]] = load("robots/p3dx-sh")["sonar"]
POSES: Final = {pose["number"]: pose for pose in _SONAR["pose"]}
NO_ECHO_MM: Final[int] = _SONAR["no_echo_mm"]
MIN_MM: Final[int] = _SONAR["min_mm"]
FIELD_OF_VIEW_RAD: Final = math.radians(_SONAR["cone_deg"])
FRAME_ROBOT, FRAME_WORLD = "base_link", "odom"
_INFO, _ERROR = 2, 4  # levels of foxglove.Log
_LINE_MAX: Final = 0xFFFFFFFF

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


_STRING: Final = {"type": "string"}
_BOOLEAN: Final = {"type": "boolean"}
_INTEGER: Final = {"type": "integer"}
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
        pose={**_POSE, "description": "of the transducer in frame_id; absent for a sonar that a P3-DX lacks"},
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
}


def _orientation(heading_deg: float) -> dict[str, float]:
    half = math.radians(heading_deg) / 2
    return {"x": 0.0, "y": 0.0, "z": math.sin(half), "w": math.cos(half)}


def _pose(x_mm: float, y_mm: float, heading_deg: float) -> dict[str, Any]:
    position = {"x": x_mm / 1000, "y": y_mm / 1000, "z": 0.0}
    return {"position": position, "orientation": _orientation(heading_deg)}


_SONAR_POSES: Final = {
    number: _pose(pose["x_mm"], pose["y_mm"], pose["heading_deg"]) for number, pose in POSES.items()
}


class _Output:
    """An MCAP file with a channel for each topic that is used."""

    def __init__(self, stream: Any) -> None:
        self._writer = Writer(stream)
        self._writer.start(library="argus-log")
        self._schemas: dict[str, int] = {}
        self._channels: dict[str, int] = {}
        self._sequence = itertools.count()

    def put(self, topic: str, schema: str, t_ns: int, message: dict[str, Any]) -> None:
        """Append one message."""
        channel = self._channels.get(topic)
        if channel is None:
            if schema not in self._schemas:
                text = json.dumps(SCHEMAS[schema]).encode()
                self._schemas[schema] = self._writer.register_schema(schema, "jsonschema", text)
            channel = self._writer.register_channel(topic, "json", self._schemas[schema])
            self._channels[topic] = channel
        stamp = {"sec": t_ns // 1_000_000_000, "nsec": t_ns % 1_000_000_000}
        data = json.dumps({"timestamp": stamp, **message}).encode()
        self._writer.add_message(channel, t_ns, data, t_ns, next(self._sequence))

    def close(self) -> None:
        """Write the summary."""
        self._writer.finish()  # type: ignore[no-untyped-call]


def _put_sip(output: _Output, t_ns: int, fields: dict[str, Any]) -> None:
    properties = SCHEMAS["argus.RobotState"]["properties"]
    state = {name: fields[name] for name in properties if name in fields}
    output.put("/robot/state", "argus.RobotState", t_ns, state)
    place = _pose(fields["x_mm"], fields["y_mm"], fields["heading_deg"])
    output.put("/odometry", "foxglove.PoseInFrame", t_ns, {"frame_id": FRAME_WORLD, "pose": place})
    frames = {"parent_frame_id": FRAME_WORLD, "child_frame_id": FRAME_ROBOT}
    transform = {**frames, "translation": place["position"], "rotation": place["orientation"]}
    output.put("/tf", "foxglove.FrameTransform", t_ns, transform)
    for number, range_mm in fields["sonar"].items():
        is_echo = range_mm < NO_ECHO_MM
        reading = {
            "frame_id": FRAME_ROBOT,
            "sonar": int(number),
            "range_mm": range_mm,
            "valid": is_echo and range_mm >= MIN_MM,
            "field_of_view_rad": FIELD_OF_VIEW_RAD,
            "min_range_m": MIN_MM / 1000,
            "max_range_m": NO_ECHO_MM / 1000,
        }
        if is_echo:
            reading["range_m"] = range_mm / 1000
        if pose := _SONAR_POSES.get(int(number)):
            reading["pose"] = pose
        output.put(f"/sonar/{int(number):02d}", "argus.SonarRange", t_ns, reading)


def write_mcap(stream: Any, first: Row, rows: Iterator[Row], decoder: Decoder) -> int:
    """Write the rows, which the decoder has tracked; return how many there were."""
    output = _Output(stream)
    count = 0
    for row in itertools.chain((first,), rows):
        count += 1
        t_ns = max(0, round((row.t or 0.0) * 1e9))
        fields = decoder.fields(row)
        if fields["ok"] and row.type == "SIP":
            _put_sip(output, t_ns, fields)
            continue
        detail = {
            name: value for name, value in fields.items() if name not in ("t", "offset", "dir", "type", "ok")
        }
        level = _INFO if fields["ok"] else _ERROR
        words = f"{row.type} damaged: {row.error}" if not fields["ok"] else f"{row.type} {json.dumps(detail)}"
        place = {"file": row.dir, "line": min(row.offset, _LINE_MAX)}
        output.put(
            "/events", "foxglove.Log", t_ns, {"level": level, "message": words, "name": row.dir, **place}
        )
    output.close()
    return count
