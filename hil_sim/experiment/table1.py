# SPDX-License-Identifier: MIT
"""Table I of the paper: an object on the bearing of each sonar in turn; the robot drives on until one sees it."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import yaml

from hil_sim.experiment.home import off_deg
from hil_sim.experiment.stage import Seen, Stage
from hil_sim.sil import Mission
from hil_sim.tables.robot import robot_table

PAPER: Final[Mapping[int, int]] = {1: 241, 2: 240, 3: 242, 4: 238, 5: 237, 6: 232}
"""Final readings of the sonar that saw the object; the paper counts bearings clockwise, its 50 degrees are sonar 6."""
RANGE_MM: Final = 250
SPEEDS_MM_S: Final = (50, 100, 200)
DRIVEN_MM: Final = 400.0
"""The way to the place where the object comes into range."""
_BEYOND_MM: Final = 200.0
"""The goal lies so near behind that place that no way round the object is looked for."""
_POST_MM: Final = 60.0
_ROOM_MM: Final = 1500
_LIMIT_S: Final = 60.0
_AFTER_S: Final = 0.9
_TURNED_DEG: Final = 1.0


@dataclass(frozen=True)
class Row:
    """One drive: which sonars were to see the object, which did, and the last reading of each of the six before
    anything else."""

    sonar: int
    bearing_deg: int
    speed_mm_s: int
    seen_by: int | None
    final_mm: Mapping[int, int]


def world_text(sonar: int) -> str:
    """Return a room with a post that comes into range of this sonar after 400 mm of way."""
    mount = robot_table().mounts[sonar]
    far = RANGE_MM + _POST_MM / 2
    x = DRIVEN_MM + mount.x_mm + far * math.cos(math.radians(mount.heading_deg))
    y = mount.y_mm + far * math.sin(math.radians(mount.heading_deg))
    left, right, half = -_ROOM_MM, 2 * _ROOM_MM, _ROOM_MM
    world = {
        "about": f"A post on the bearing of sonar {sonar}.",
        "start": [0, 0, 0],
        "roughness": 1.0,
        "walls": [{"points": [[left, -half], [right, -half], [right, half], [left, half]], "closed": True}],
        "posts": [{"centre": [round(x, 1), round(y, 1)], "diameter": _POST_MM}],
    }
    return yaml.safe_dump(world)


def run_one(stage: Stage, sonar: int, speed_mm_s: int, seed: int) -> Row:
    """Drive at one object."""
    with tempfile.TemporaryDirectory(prefix="argus-table1-") as folder:
        path = Path(folder) / f"post-{sonar}-{seed}.yaml"
        path.write_text(world_text(sonar), encoding="utf-8")
        config = {"profile": "paper", "object_range_mm": str(RANGE_MM), "speed_mm_s": str(speed_mm_s)}
        goal = (DRIVEN_MM + _BEYOND_MM, 0.0)
        mission = Mission(
            str(path), (goal,), seed=seed, config=config, sonar={"crosstalk": 0.0}, limit_s=_LIMIT_S
        )
        seen = stage(mission, _has_stopped)
    mount = robot_table().mounts[sonar]
    found = [event.sonar for event in seen.events if event.name == "OBJECT"]
    return Row(sonar, round(mount.heading_deg), speed_mm_s, found[0] if found else None, _final(seen))


def _has_stopped(seen: Seen) -> bool:
    """The object is seen and each sonar has been read once more at rest."""
    if not any(event.name == "OBJECT" for event in seen.events):
        return False
    last = seen.states[-1]
    before = [state for state in seen.states[-200:] if state.t_s >= last.t_s - _AFTER_S]
    return max(math.dist(state[1:3], last[1:3]) for state in before) < 1.0


def _final(seen: Seen) -> dict[int, int]:
    """The last reading of each of the six where the robot stopped, before it turned."""
    last = seen.states[-1]
    there = [state for state in seen.states if math.dist(state[1:3], last[1:3]) < 1.0]
    turned = [state.t_s for state in there if off_deg(state.heading_deg, there[0].heading_deg) > _TURNED_DEG]
    until = turned[0] if turned else math.inf
    forward = robot_table().forward
    return {r.sonar: r.range_mm for r in seen.readings if r.t_s <= until and r.sonar in forward}


def run(stage: Stage, seed: int = 1, speeds: tuple[int, ...] = SPEEDS_MM_S) -> list[Row]:
    """Drive at an object on each of the six bearings, at each speed."""
    return [run_one(stage, sonar, speed, seed) for speed in speeds for sonar in robot_table().forward]


def table(rows: list[Row]) -> str:
    """Return the table in Markdown: ours beside the paper's."""
    speeds = sorted({row.speed_mm_s for row in rows})
    head = " | ".join(f"{speed} mm/s" for speed in speeds)
    lines = [
        f"| object on | sonar | the paper | {head} | what the others read, at {speeds[0]} mm/s |",
        "|---|---|---|" + "---|" * (len(speeds) + 1),
    ]
    for sonar in robot_table().forward:
        own = {row.speed_mm_s: row for row in rows if row.sonar == sonar}
        finals = " | ".join(_cell(own[speed]) for speed in speeds)
        others = ", ".join(str(mm) for n, mm in sorted(own[speeds[0]].final_mm.items()) if n != sonar)
        bearing = own[speeds[0]].bearing_deg
        lines.append(f"| {bearing:+d} | {sonar} | {PAPER[sonar]} | {finals} | {others} |")
    return "\n".join(lines) + "\n"


def _cell(row: Row) -> str:
    if row.seen_by is None:
        return "not seen"
    return f"{row.final_mm.get(row.sonar)}" + (
        "" if row.seen_by == row.sonar else f" (seen by {row.seen_by})"
    )
