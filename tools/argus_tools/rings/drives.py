# SPDX-License-Identifier: MIT
"""Drives that others have recorded, with odometry and a laser, as lines of JSON.

python -m argus_tools.rings.drives FILE

The bench of the emulator makes sonars of them. A line is one scan: "t" in s, "x", "y" in m and "heading" in rad by
the odometry, "laser" where it stands on the robot, "angles" of the first beam and from one to the next, "mm" of each
beam, 0 for no return.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, islice
from pathlib import Path
from typing import Any, Final

import numpy as np

from argus_tools.chunks import DamageList, LogError
from argus_tools.rings.columns import (
    SURVEYED,
    Columns,
    Reading,
    Row,
    json_rows,
    table_rows,
    understood,
)
from argus_tools.rings.dated import Dated
from argus_tools.rings.intake import Odd
from argus_tools.rings.plan import Place, planned
from argus_tools.rings.recording import Bag, Broken, OwnMcap, Recording
from argus_tools.rings.sensors import SCAN
from hil_sim.tables.robot import robot_table

CARMEN_FAR_M: Final = 80.0
"""What a log of CARMEN has for no return is a little more."""
_LASER: Final = "FLASER "
_TABLES: Final = {".csv": table_rows, ".tsv": table_rows, ".jsonl": json_rows}
BEAMS_LEAST: Final = 33
"""So many ranges in a row of a table are beams of a laser: no robot has so many sonars."""
_ANGLES: Final = ("angle_min", "angle_increment")
"""Columns with the first bearing and the step, rad; without them the beams are of half a turn, right to left."""

Line = dict[str, Any]


def lines_of(path: Path) -> Iterator[Line]:
    """Yield the scans of a bag, an MCAP file, a table or a log of CARMEN; LogError where there are none."""
    if path.is_dir() or path.suffix in (".bag", ".db3", ".mcap"):
        yield from _of_bag(path)
    elif path.suffix in _TABLES:
        yield from _of_table(path)
    else:
        yield from _of_carmen(path)


def _opened(path: Path) -> Recording:
    if path.suffix == ".mcap" and not path.is_dir():
        return OwnMcap(path, path.name)
    folder = path.parent if path.suffix == ".db3" else path
    return Bag(folder, path.suffix == ".bag", path.name)


def _of_bag(path: Path) -> Iterator[Line]:
    recording = _opened(path)
    try:
        scans = [topic for topic in recording.topics if topic.type == SCAN and topic.count]
        if not scans:
            raise LogError(f"{path.name}: no scan of a laser in it")
        topic = max(scans, key=lambda one: one.count).name
        yield from _scans(recording, path.name, topic)
    finally:
        recording.close()


def _scans(recording: Recording, name: str, topic: str) -> Iterator[Line]:
    plan = planned(recording, name, topic, None)
    if not plan.odometry and not plan.transforms:
        raise LogError(f"{name}: no odometry in it")
    place, corrected = Place(plan), DamageList()
    wanted = [topic, *filter(None, [plan.odometry]), *plan.transforms]
    try:
        for message, _ in Dated(recording.messages(wanted), [topic], corrected):
            try:
                if message.topic != topic:
                    place.take(message)
                    continue
            except Odd:
                continue
            at, body = place.at(message.t), message.body
            laser = plan.frames.on_robot(body.header.frame_id)
            ranges = np.asarray(body.ranges, dtype=np.float64)
            yield {
                "t": message.t,
                "x": at.x_m,
                "y": at.y_m,
                "heading": at.heading_rad,
                "laser": [laser.x_m, laser.y_m, laser.yaw_rad] if laser is not None else [0.0, 0.0, 0.0],
                "angles": [float(body.angle_min), float(body.angle_increment)],
                "mm": _millimetres(ranges, float(body.range_min), float(body.range_max)),
            }
    except Broken as error:
        print(f"{name}: {error}; the rest is not read", file=sys.stderr)
    for found in corrected:
        print(f"{name}: {found.place}: {found.what}", file=sys.stderr)


def _millimetres(ranges: Any, least_m: float, most_m: float) -> list[int]:
    with np.errstate(invalid="ignore"):
        echo = (ranges >= least_m) & (ranges < most_m) & (ranges > 0)
    found: list[int] = (
        np.where(echo, np.nan_to_num(ranges, posinf=0, neginf=0) * 1000, 0).round().astype(int).tolist()
    )
    return found


def _beams(name: str, rows: Sequence[Row]) -> Columns:
    """The columns of a table; LogError where they are not those of a laser on a robot that drives."""
    columns = understood(list(dict.fromkeys(column for _, row in rows for column in row)))
    if not columns.is_ring or not {"x", "y", "heading"} <= columns.known.keys():
        raise LogError(
            f"{name}: no columns of time, pose and ranges: t_s, x_m, y_m, heading_deg, range_0_m, ..."
        )
    if len(columns.ranges) < BEAMS_LEAST:
        raise LogError(
            f"{name}: {len(columns.ranges)} ranges a row are of sonars; this makes sonars of the beams of a laser"
        )
    return columns


def _angles(row: Mapping[str, Any], beams: int) -> list[float]:
    """The first bearing and the step, rad."""
    try:
        first, step = (float(row[name]) for name in _ANGLES)
    except (KeyError, TypeError, ValueError):
        return [-math.pi / 2, _half_turn(beams)]
    return [first, step]


def _of_table(path: Path) -> Iterator[Line]:
    damage = DamageList()
    with path.open("rb") as stream:
        rows = _TABLES[path.suffix](stream, damage)
        head = list(islice(rows, SURVEYED))
        columns = _beams(path.name, head)
        reading = Reading(columns, head, robot_table().motion["track_mm"])
        beams = max(columns.ranges) + 1
        for _, row in chain(head, rows):
            t, place, ranges = reading.time(row), reading.motion(row), reading.ranges(row)
            if place is None or not math.isfinite(t):
                continue
            far_m = np.array([ranges.get(k, 0.0) for k in range(beams)])
            yield {
                "t": t, "x": place.x_m, "y": place.y_m, "heading": place.heading_rad, "laser": [0.0, 0.0, 0.0],
                "angles": _angles(row, beams), "mm": _millimetres(far_m, 0.0, CARMEN_FAR_M),
            }  # fmt: skip
    for found in damage:
        print(f"{path.name}: {found.place}: {found.what}", file=sys.stderr)


def _half_turn(beams: int) -> float:
    return math.pi / (beams - beams % 2)


def _of_carmen(path: Path) -> Iterator[Line]:
    count = 0
    with path.open(encoding="utf-8", errors="replace") as file:
        for text in file:
            line = _carmen(text.split()) if text.startswith(_LASER) else None
            if line is not None:
                count += 1
                yield line
    if not count:
        raise LogError(f"{path.name}: neither a bag or a table, nor a log of CARMEN with scans (FLASER)")


def _carmen(words: Sequence[str]) -> Line | None:
    """One scan of a log of CARMEN, of half a turn; None of a line that is cut."""
    try:
        beams = int(words[1])
        values = [float(word) for word in words[2 : 2 + beams]]
        laser_x, laser_y, _, x, y, heading = map(float, words[2 + beams : 8 + beams])
        t = float(words[7 + beams + 3])
    except (IndexError, ValueError):
        return None
    if beams < 2:
        return None
    along = (laser_x - x) * math.cos(heading) + (laser_y - y) * math.sin(heading)
    return {
        "t": t, "x": x, "y": y, "heading": heading, "laser": [along, 0.0, 0.0],
        "angles": [-math.pi / 2, _half_turn(beams)], "mm": _millimetres(np.array(values), 0.0, CARMEN_FAR_M),
    }  # fmt: skip


def main(words: Sequence[str]) -> int:
    """Print the scans of a file; return the exit code."""
    try:
        for line in lines_of(Path(words[0])):
            print(json.dumps(line), flush=False)
    except (LogError, OSError) as error:
        print(error, file=sys.stderr)
        return 2
    except BrokenPipeError:
        return 0
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
