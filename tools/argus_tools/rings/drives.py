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
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from argus_tools.chunks import DamageList, LogError
from argus_tools.rings.dated import Dated
from argus_tools.rings.intake import Odd
from argus_tools.rings.plan import Place, planned
from argus_tools.rings.recording import Bag, Broken, OwnMcap, Recording
from argus_tools.rings.sensors import SCAN

CARMEN_FAR_M: Final = 80.0
"""What a log of CARMEN has for no return is a little more."""
_LASER: Final = "FLASER "

Line = dict[str, Any]


def lines_of(path: Path) -> Iterator[Line]:
    """Yield the scans of a bag, an MCAP file or a log of CARMEN; LogError where there are none."""
    if path.is_dir() or path.suffix in (".bag", ".db3", ".mcap"):
        yield from _of_bag(path)
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


def _of_carmen(path: Path) -> Iterator[Line]:
    count = 0
    with path.open(encoding="utf-8", errors="replace") as file:
        for text in file:
            line = _carmen(text.split()) if text.startswith(_LASER) else None
            if line is not None:
                count += 1
                yield line
    if not count:
        raise LogError(f"{path.name}: neither a bag, nor a log of CARMEN with scans (FLASER)")


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
    step = math.pi / (beams - beams % 2)
    along = (laser_x - x) * math.cos(heading) + (laser_y - y) * math.sin(heading)
    return {
        "t": t, "x": x, "y": y, "heading": heading, "laser": [along, 0.0, 0.0],
        "angles": [-math.pi / 2, step], "mm": _millimetres(np.array(values), 0.0, CARMEN_FAR_M),
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
