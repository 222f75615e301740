# SPDX-License-Identifier: MIT
"""A log as MCAP with JSON schemas: one channel per sonar, odometry, robot state and events, for Foxglove."""

from __future__ import annotations

import itertools
import json
from collections.abc import Iterator
from typing import Any, Final

from mcap.writer import Writer

from argus_tools.formats.timeline import nanoseconds
from argus_tools.foxglove import (
    BEAMS,
    ERROR,
    EVENTS,
    INFO,
    ODOMETRY,
    SCHEMAS,
    STATE,
    TF,
    Sonars,
    places,
    sonar_topic,
    sonars_of,
    stamp_of,
)
from argus_tools.log.fields import Decoder
from argus_tools.log.packets import Row
from hil_sim.tables.robot import DEFAULT_ROBOT

_LINE_MAX: Final = 0xFFFFFFFF


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
        stamp = {"timestamp": stamp_of(t_ns)} if "timestamp" in SCHEMAS[schema]["properties"] else {}
        data = json.dumps({**stamp, **message}).encode()
        self._writer.add_message(channel, t_ns, data, t_ns, next(self._sequence))

    def close(self) -> None:
        """Write the summary."""
        self._writer.finish()  # type: ignore[no-untyped-call]


def _put_sip(output: _Output, t_ns: int, fields: dict[str, Any], sonars: Sonars) -> None:
    properties = SCHEMAS["argus.RobotState"]["properties"]
    state = {name: fields[name] for name in properties if name in fields}
    output.put(STATE, "argus.RobotState", t_ns, state)
    place, transform = places(fields["x_mm"], fields["y_mm"], fields["heading_deg"])
    output.put(ODOMETRY, "foxglove.PoseInFrame", t_ns, place)
    output.put(TF, "foxglove.FrameTransform", t_ns, transform)
    readings = {int(number): range_mm for number, range_mm in fields["sonar"].items()}
    for number, range_mm in readings.items():
        output.put(sonar_topic(number), "argus.SonarRange", t_ns, sonars.reading(number, range_mm))
    if readings:
        output.put(BEAMS, "foxglove.SceneUpdate", t_ns, sonars.beams(stamp_of(t_ns), readings))


def write_mcap(stream: Any, first: Row, rows: Iterator[Row], decoder: Decoder) -> int:
    """Write the rows, which the decoder has tracked; return how many there were."""
    output = _Output(stream)
    sonars = sonars_of(DEFAULT_ROBOT)
    count = 0
    for row in itertools.chain((first,), rows):
        count += 1
        t_ns = nanoseconds(row.t or 0.0)
        fields = decoder.fields(row)
        if fields["ok"] and row.type == "SIP":
            _put_sip(output, t_ns, fields, sonars)
            continue
        detail = {
            name: value for name, value in fields.items() if name not in ("t", "offset", "dir", "type", "ok")
        }
        level = INFO if fields["ok"] else ERROR
        words = f"{row.type} damaged: {row.error}" if not fields["ok"] else f"{row.type} {json.dumps(detail)}"
        place = {"file": row.dir, "line": min(row.offset, _LINE_MAX)}
        output.put(EVENTS, "foxglove.Log", t_ns, {"level": level, "message": words, "name": row.dir, **place})
    output.close()
    return count
