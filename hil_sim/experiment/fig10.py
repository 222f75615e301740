# SPDX-License-Identifier: MIT
"""Fig. 10 of the paper: in failure mode the robot stops each 200 mm and turns living sonars onto the blind bearing."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Final

import yaml

from hil_sim.experiment.home import off_deg
from hil_sim.experiment.stage import Seen, Stage, State
from hil_sim.sil import Mission
from hil_sim.world.files import load_world

DEAD: Final = 3
GOAL: Final = (1700.0, 0.0)
"""So near the post that no way round it is looked for."""
WORLD: Final[Mapping[str, object]] = {
    "about": "A room with a post on the bearing of the dead sonar.",
    "start": [0, 0, 0],
    "roughness": 1.0,
    "walls": [{"points": [[-800, -1100], [2900, -1100], [2900, 1100], [-800, 1100]], "closed": True}],
    "posts": [{"centre": [1900, 85], "diameter": 70}],
}
LIMIT_S: Final = 120.0
_MOVED_MM: Final = 20.0
_STILL_MM: Final = 2.0
_TURNED_DEG: Final = 8.0


@dataclass(frozen=True)
class Stop:
    """A place where the robot stood, its heading of the way, and where else it looked from there."""

    x_mm: float
    y_mm: float
    heading_deg: float
    looks_deg: tuple[float, ...]


@dataclass(frozen=True)
class Drive:
    """What came of it. walls: segments of the world."""

    seen: Seen
    stops: tuple[Stop, ...]
    walls: Sequence[Sequence[float]]

    @property
    def steps_mm(self) -> list[float]:
        """Ways between stops."""
        return [math.hypot(b.x_mm - a.x_mm, b.y_mm - a.y_mm) for a, b in pairwise(self.stops)]


def run(stage: Stage, seed: int = 1) -> Drive:
    """Drive towards a goal with one dead sonar, by the paper's rules."""
    with tempfile.TemporaryDirectory(prefix="argus-fig10-") as folder:
        path = Path(folder) / f"post-{seed}.yaml"
        path.write_text(yaml.safe_dump(dict(WORLD)), encoding="utf-8")
        mission = Mission(
            str(path),
            (GOAL,),
            faults=(f"off:{DEAD}",),
            seed=seed,
            config={"profile": "paper"},
            sonar={"crosstalk": 0.0},
            limit_s=LIMIT_S,
        )
        seen = stage(mission, _has_ended)
        walls = load_world(str(path)).segments.tolist()
    return Drive(seen, tuple(_stops(seen.states)), walls)


def _has_ended(seen: Seen) -> bool:
    """The object is found in a turn, or the drive is over without."""
    return any(event.name in ("OBJECT_CHECKED", "GOAL_REACHED", "MISSION_FAILED") for event in seen.events)


def _stops(states: Sequence[State]) -> list[Stop]:
    """Places where the robot stood still or turned, from the first move on."""
    stops: list[Stop] = []
    group: list[State] = []
    for before, now in pairwise(states):
        if math.dist(before[1:3], now[1:3]) <= _STILL_MM:
            group.append(now)
            continue
        _end(group, stops)
        group = []
    _end(group, stops)
    return stops


def _end(group: Sequence[State], stops: list[Stop]) -> None:
    if len(group) < 3:
        return
    last = group[-1]
    if stops and math.hypot(stops[-1].x_mm - last.x_mm, stops[-1].y_mm - last.y_mm) < _MOVED_MM:
        return
    rests = [b for a, b in pairwise(group) if off_deg(a.heading_deg, b.heading_deg) < 0.3]
    looks: list[float] = []
    for state in rests:
        away = off_deg(state.heading_deg, last.heading_deg) > _TURNED_DEG
        if away and all(off_deg(state.heading_deg, known) > _TURNED_DEG for known in looks):
            looks.append(state.heading_deg)
    stops.append(Stop(last.x_mm, last.y_mm, last.heading_deg, tuple(looks)))


def summary(drive: Drive) -> str:
    """Return what the drive shows, in Markdown."""
    turns = sum(len(stop.looks_deg) for stop in drive.stops)
    found = drive.seen.values("OBJECT_CHECKED")
    steps = drive.steps_mm
    lines = [
        "| stops | steps, mm | turns | found in a turn |",
        "|---|---|---|---|",
        f"| {len(drive.stops)} | {min(steps):.0f} to {max(steps):.0f} | {turns} | "
        f"{'the post, at ' + str(found[0]) + ' mm' if found else 'nothing'} |",
    ]
    return "\n".join(lines) + "\n"
