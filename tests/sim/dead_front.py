# SPDX-License-Identifier: MIT
"""A campaign of missions whose front array dies on the way to a box, and of healthy ones in the same worlds."""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from hil_sim.sil import Mission, Outcome, run
from hil_sim.world.files import load_world

GOAL_MM: Final = 14_000.0
SAME_PLACE_MM: Final = 300.0
"""Two contacts so near to each other are of one place."""
FRONT: Final = range(8)
LIMIT_S: Final = {"robot": 200.0, "mobilesim": 400.0}
WALLS: Final = {"none": (), "left": (1,), "right": (-1,), "both": (1, -1)}
LOST: Final = ("SLIP", "ODOMETRY_LOST")


@dataclass(frozen=True)
class Case:
    """One mission: what stands where, when the front dies (s, None: never), and by whose habits it drives."""

    kind: str = "hall"
    walls: str = "left"
    wall_mm: float = 2000.0
    box_x_mm: float | None = 8000.0
    box_y_mm: float = 0.0
    box_mm: float = 400.0
    onset_s: float | None = 9.0
    quirks: str = "robot"
    seed: int = 1
    creep_mm_s: int = 0

    def world(self) -> str:
        """Return the text of the world's file."""
        ends = (-2000.0, 17_000.0) if self.kind == "corridor" else (-8000.0, 26_000.0)
        half_mm = self.wall_mm if self.kind == "corridor" else 11_000.0
        round_mm = [(ends[0], -half_mm), (ends[1], -half_mm), (ends[1], half_mm), (ends[0], half_mm)]
        lines = ["about: A dead front array.", "start: [0, 0, 0]", "roughness: 0.6", "walls:"]
        lines.append(f"  - {{points: {[list(p) for p in round_mm]}, closed: true}}")
        if self.kind == "hall":
            for side in WALLS[self.walls]:
                y_mm = side * self.wall_mm
                lines.append(f"  - {{points: {[[-2000.0, y_mm], [18_000.0, y_mm]]}}}")
        if self.box_x_mm is not None:
            at, size = [self.box_x_mm, self.box_y_mm], [self.box_mm, self.box_mm]
            lines += ["boxes:", f"  - {{centre: {at}, size: {size}, roughness: 1.0}}"]
        return "\n".join(lines) + "\n"

    def mission(self, folder: Path) -> Mission:
        """Write the world and return the mission."""
        place = f"{self.kind}-{self.walls}-{self.wall_mm:.0f}-{self.box_x_mm}-{self.box_y_mm}-{self.box_mm}"
        file = folder / f"{place}.yaml"
        if not file.exists():
            file.write_text(self.world(), encoding="utf-8")
        off = () if self.onset_s is None else tuple(f"off:{k}@{self.onset_s}s" for k in FRONT)
        return Mission(
            str(file),
            ((GOAL_MM, 0.0),),
            faults=off,
            seed=self.seed,
            quirks=self.quirks,
            config={"creep_mm_s": self.creep_mm_s},
            limit_s=LIMIT_S[self.quirks],
        )


@dataclass(frozen=True)
class Verdict:
    """What came of a case: contacts, those at a place touched before, and how the mission ended."""

    case: Case
    hits: int
    again: int
    reached: bool
    failed: bool
    lost: bool
    found_s: float | None
    t_s: float

    def __str__(self) -> str:
        end = "reached" if self.reached else "FAILED" if self.failed else "out of time"
        found = "never" if self.found_s is None else f"{self.found_s:.1f} s"
        return (
            f"{self.hits} hits, {self.again} again, {end} after {self.t_s:.0f} s, found after {found}"
            f"{', odometry doubted' if self.lost else ''}: {self.case}"
        )


def contact(world: str, x_mm: float, y_mm: float) -> tuple[float, float]:
    """Return the place of the world's solids that is nearest to a body there."""
    best, nearest = (x_mm, y_mm), math.inf
    for x1, y1, x2, y2 in load_world(world).segments:
        dx, dy = float(x2 - x1), float(y2 - y1)
        part = min(1.0, max(0.0, ((x_mm - x1) * dx + (y_mm - y1) * dy) / (dx * dx + dy * dy)))
        place = float(x1) + part * dx, float(y1) + part * dy
        away = math.hypot(place[0] - x_mm, place[1] - y_mm)
        if away < nearest:
            best, nearest = place, away
    return best


def second_hits(places: Sequence[tuple[float, float]]) -> int:
    """Return how many of the contacts are at a place that was touched before."""
    return sum(
        any(math.dist(place, before) <= SAME_PLACE_MM for before in places[:k])
        for k, place in enumerate(places)
    )


def judge(case: Case, seen: Outcome) -> Verdict:
    """Return what came of a case."""
    places = [contact(seen.mission.world, hit.x, hit.y) for hit in seen.collisions if not hit.struck]
    names = [event.name for event in seen.events]
    onset_s = math.inf if case.onset_s is None else case.onset_s
    found = [
        event.t_s - onset_s
        for event in seen.events
        if event.name == "SONAR_DISABLED" and event.sonar in range(1, 7) and event.t_s >= onset_s
    ]
    return Verdict(
        case,
        len(places),
        second_hits(places),
        "GOAL_REACHED" in names,
        "MISSION_FAILED" in names,
        any(name in LOST for name in names),
        found[0] if found else None,
        seen.t_s,
    )


def drive(case: Case, folder: Path) -> Verdict:
    """Drive one case."""
    return judge(case, run(case.mission(folder)))


def drive_in(task: tuple[Case, str]) -> Verdict:
    """Drive one case of a pool."""
    return drive(task[0], Path(task[1]))


def drive_all(cases: Iterable[Case], folder: Path, jobs: int = 1) -> list[Verdict]:
    """Drive cases side by side."""
    tasks = [(case, str(folder)) for case in cases]
    if jobs == 1:
        return [drive_in(task) for task in tasks]
    with ProcessPoolExecutor(jobs) as pool:
        return list(pool.map(drive_in, tasks))


ONSETS_S: Final = (6.0, 9.0, 12.0)
PLACES: Final = ((1000.0, 300.0), (2000.0, 400.0), (3000.0, 800.0))
"""Distance of the walls and size of the box."""


def cases(quirks: Iterable[str], seeds: Iterable[int], creep_mm_s: int = 0) -> list[Case]:
    """Return the cases with a dead front: halls and corridors, all walls, boxes at and beside the axis."""
    found: list[Case] = []
    halls = [("hall", walls) for walls in WALLS]
    for habits, (kind, walls), seed in product(quirks, [*halls, ("corridor", "both")], seeds):
        for k, (wall_mm, box_mm) in enumerate(PLACES):
            onset_s = ONSETS_S[(k + seed) % len(ONSETS_S)]
            late = 2.5 if habits == "mobilesim" else 1.0
            box_x_mm = 3500.0 + 350.0 * onset_s + (seed * 37 + k * 11) % 7 * 180.0
            box_y_mm = ((seed * 13 + k * 5) % 5 - 2) * 90.0
            if walls == "both" and wall_mm < 1500:
                box_y_mm = math.copysign(600.0, box_y_mm)  # else no robot gets by, a healthy one no more
            found.append(
                Case(
                    kind, walls, wall_mm, box_x_mm, box_y_mm, box_mm, onset_s * late, habits, seed, creep_mm_s
                )
            )
    return found


def healthy(quirks: Iterable[str], seeds: Iterable[int]) -> list[Case]:
    """Return the same worlds with a front that lives."""
    return [
        Case(
            case.kind,
            case.walls,
            case.wall_mm,
            case.box_x_mm,
            case.box_y_mm,
            case.box_mm,
            None,
            case.quirks,
            case.seed,
        )
        for case in cases(quirks, seeds)
    ]


def main() -> None:
    """Drive the campaign and print what came of it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quirks", default="robot,mobilesim")
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--healthy", action="store_true")
    parser.add_argument("--creep", type=int, default=0)
    asked = parser.parse_args()
    habits, seeds = asked.quirks.split(","), range(asked.first, asked.first + asked.seeds)
    with TemporaryDirectory() as folder:
        found = healthy(habits, seeds) if asked.healthy else cases(habits, seeds, asked.creep)
        seen = drive_all(found, Path(folder), asked.jobs)
    for verdict in seen:
        print(verdict)
    print(
        f"{len(seen)} missions: {sum(v.hits > 0 for v in seen)} with a hit, {sum(v.again for v in seen)} second hits,"
        f" {sum(v.reached for v in seen)} reached, {sum(v.failed for v in seen)} given up,"
        f" {sum(v.lost for v in seen)} with SLIP or ODOMETRY_LOST"
    )


if __name__ == "__main__":
    main()
