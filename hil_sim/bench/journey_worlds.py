# SPDX-License-Identifier: MIT
"""Worlds of the journeys made from a seed: obstacle sets with a goal each, and floors as ARIA maps."""

from __future__ import annotations

import tempfile
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import Final

import numpy as np

from hil_sim.bench.course import ROOM_MM, Field, Point, make_field
from hil_sim.bench.journey_course import DRIFT_DEG_M, LEAST_MM, drift_at_goal_mm, drift_course, length_mm
from hil_sim.bench.worlds import Plan
from hil_sim.errors import SimError
from hil_sim.tables.robot import robot_table
from hil_sim.world.files import load_world
from hil_sim.world.model import Pose, World

Rng = np.random.Generator
LIMIT_S: Final = 900.0
SET_LIMIT_S: Final = 300.0
"""The limit of an obstacle set; its courses are some 10 m long."""
_TRIES: Final = 60
_PLACES_LEAST: Final = 200
"""Cells of 50 mm where a waypoint may lie, or the plan is thrown away."""
_HALF_MM: Final = robot_table().body.half_mm
_OFF_MM: Final = 90.0
"""A floor where drift has the robot further from its goal is thrown away."""
_PAIR_MM: Final = (3000.0, 11_000.0)
_ICON: Final = '"" ICON'


@dataclass(frozen=True, eq=False)
class Place:
    """A world and the way through it. path: as `Mission.world` has it. start: None takes the world's."""

    world: World
    field: Field
    path: str
    course: tuple[Point, ...]
    limit_s: float
    start: Pose | None = None

    @property
    def begins(self) -> Pose:
        """Where the robot starts."""
        return self.start if self.start is not None else self.world.start


# ---- obstacle sets: from the origin, heading along x, to one goal -------------------------------------------------


def _doors(rng: Rng) -> tuple[Plan, Point]:
    """A wall with a door of 1000 mm; the straight way passes it within 400 mm of its middle."""
    plan = Plan("Two rooms and a door of 1000 mm.", round(float(rng.uniform(0.4, 0.9)), 2))
    at, door = float(rng.uniform(1600, 3500)), float(rng.uniform(-700, 700))
    goal_x = at + float(rng.uniform(1300, 3500))
    crossing = door + float(rng.uniform(-400, 400))
    goal_y = float(np.clip(crossing * goal_x / at, -1600, 1600))
    plan.outline(-1300, -2300, at + 4300, 2300)
    plan.wall((at, -2300), (at, door - 500))
    plan.wall((at, door + 500), (at, 2300))
    return plan, (goal_x, goal_y)


def _corridors(rng: Rng) -> tuple[Plan, Point]:
    """A corridor of 1200 mm between two rooms; both ends lie somewhere beside it."""
    plan = Plan("A corridor of 1200 mm between two rooms.", round(float(rng.uniform(0.3, 0.9)), 2))
    begin, length = float(rng.uniform(1300, 2200)), float(rng.uniform(3000, 8000))
    middle, end = float(rng.uniform(-400, 400)), 0.0
    end = begin + length
    low, high = middle - 600, middle + 600
    points = [
        (begin, low), (begin, -2000), (-1300, -2000), (-1300, 2000), (begin, 2000), (begin, high), (end, high),
        (end, 2000), (end + 3000, 2000), (end + 3000, -2000), (end, -2000), (end, low), (begin, low),
    ]  # fmt: skip
    plan.wall(*points)
    return plan, (end + float(rng.uniform(900, 2000)), float(rng.uniform(-900, 900)))


def _bends(rng: Rng) -> tuple[Plan, Point]:
    """A corridor with a bend of 90 degrees, to the left or to the right, and the goal beyond it."""
    plan = Plan("A corridor with a bend.", round(float(rng.uniform(0.4, 0.9)), 2))
    half, leg, side = (
        float(rng.uniform(600, 900)),
        float(rng.uniform(2500, 4500)),
        float(rng.uniform(2500, 4500)),
    )
    sign = float(rng.choice([-1, 1]))
    corner = leg + half
    points = [
        (-1200, half), (-1200, -half), (corner, -half), (corner, side + half),
        (corner - 2 * half, side + half), (corner - 2 * half, half), (-1200, half),
    ]  # fmt: skip
    plan.wall(*[(x, sign * y) for x, y in points])
    return plan, (leg + float(rng.uniform(-100, 100)), sign * float(rng.uniform(1600, side - 100)))


def _dead_ends(rng: Rng) -> tuple[Plan, Point]:
    """A pocket of 1.5 m, open towards the robot, on the straight way to the goal."""
    plan = Plan("A dead end of 1.5 m on the way.", round(float(rng.uniform(0.4, 0.9)), 2))
    mouth, middle = float(rng.uniform(1000, 2000)), float(rng.uniform(-200, 200))
    half = float(rng.uniform(600, 800))
    end = mouth + 1500
    plan.wall((mouth, middle - half), (end, middle - half), (end, middle + half), (mouth, middle + half))
    goal_x = end + float(rng.uniform(1200, 2200))
    plan.outline(-1400, middle - half - 1800, goal_x + 1400, middle + half + 1800)
    return plan, (goal_x, middle + float(rng.uniform(-300, 300)))


def _closed(rng: Rng) -> tuple[Plan, Point]:
    """A room without a door, and the goal in it: it cannot be reached."""
    plan = Plan("A goal behind walls on all sides.", round(float(rng.uniform(0.4, 0.9)), 2))
    x, y, half = float(rng.uniform(3000, 4500)), float(rng.uniform(-800, 800)), float(rng.uniform(600, 900))
    plan.outline(-1500, -3000, x + 2500, 3000)
    plan.outline(x - half, y - half, x + half, y + half)
    return plan, (x, y)


# ---- floors ---------------------------------------------------------------------------------------------------------


def _desks(plan: Plan, rng: Rng, left: float, right: float, low: float, high: float) -> None:
    """Furniture along the walls of a room, none near its door."""
    away = high if low > 0 else low
    for _ in range(int(rng.integers(1, 4))):
        width, depth = float(rng.uniform(600, 1400)), float(rng.uniform(400, 800))
        x = float(rng.uniform(left + width / 2, right - width / 2))
        y = away - depth / 2 if low > 0 else away + depth / 2
        plan.boxes.append({"centre": [round(x), round(y)], "size": [round(width), round(depth)]})


def _office(rng: Rng, door_mm: float) -> Plan:
    """Rooms on both sides of a corridor, each with a door."""
    plan = Plan("Offices on both sides of a corridor.", 0.5)
    half, left, rooms = float(rng.uniform(800, 1100)), -2000.0, int(rng.integers(3, 5))
    ends = [left, *(left + np.cumsum(rng.uniform(3200, 4400, rooms))).round().tolist()]
    depth = float(rng.uniform(3000, 4200))
    plan.outline(left, -half - depth, ends[-1], half + depth)
    for sign in (-1.0, 1.0):
        low, high = sorted((sign * half, sign * (half + depth)))
        for a, b in pairwise(ends):
            door = float(rng.uniform(a + 800, b - 800))
            plan.wall((a, sign * half), (door - door_mm / 2, sign * half))
            plan.wall((door + door_mm / 2, sign * half), (b, sign * half))
            _desks(plan, rng, a + 150, b - 150, low, high)
        for at in ends[1:-1]:
            plan.wall((at, low), (at, high))
    return plan


def _floor(rng: Rng) -> Plan:
    """One large room with columns and partitions."""
    plan = Plan("A floor with columns and partitions.", 0.5)
    width, depth = float(rng.uniform(12_000, 18_000)), float(rng.uniform(9000, 13_000))
    left, low = -float(rng.uniform(1500, 4000)), -float(rng.uniform(3000, depth - 3000))
    plan.outline(left, low, left + width, low + depth)
    for x in np.arange(left + 3000, left + width - 1500, 4000.0).tolist():
        for y in np.arange(low + 2500, low + depth - 1500, 4000.0).tolist():
            if max(abs(x), abs(y)) < 1200:
                continue
            plan.boxes.append({"centre": [round(x), round(y)], "size": [400, 400]})
            if rng.random() < 0.6 and max(abs(x), abs(y)) > 3500:
                dx, dy = ((2000.0, 0.0), (0.0, 2000.0))[int(rng.integers(2))]
                plan.wall((x, y), (x + dx, y + dy))
    return plan


def _aria(plan: Plan) -> str:
    """The plan as an ARIA map, boxes as lines; the start is the origin."""
    lines = []
    for wall in plan.walls:
        points = wall["points"] + (wall["points"][:1] if wall.get("closed") else [])
        lines += [(*a, *b) for a, b in pairwise(points)]
    for box in plan.boxes:
        (x, y), (w, d) = box["centre"], box["size"]
        corners = [
            (x - w // 2, y - d // 2),
            (x + w // 2, y - d // 2),
            (x + w // 2, y + d // 2),
            (x - w // 2, y + d // 2),
        ]
        lines += [(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
    head = ["2D-Map", f"NumLines: {len(lines)}", f'Cairn: RobotHome 0 0 0 {_ICON} "home"', "LINES"]
    return "\n".join([*head, *(" ".join(str(round(v)) for v in line) for line in lines), ""])


SETS: Final[dict[str, Callable[[Rng], tuple[Plan, Point]]]] = {
    "doors": _doors,
    "corridors": _corridors,
    "bends": _bends,
    "dead-ends": _dead_ends,
    "closed": _closed,
    "pairs": lambda rng: (_office(rng, 1000.0), (0.0, 0.0)),
}
"""Obstacle sets: a plan and its goal; of the pairs, start and goal are drawn in the map."""
NO_WAY: Final = "closed"
"""The set with goals that cannot be reached."""
FLOORS: Final[dict[str, Callable[[Rng], Plan]]] = {
    "map-office": lambda rng: _office(rng, 1400.0),
    "map-floor": _floor,
}


def set_of(name: str) -> str:
    """Return the obstacle set of a world's name: doors of doors-3; empty when it is of none."""
    stem, _, number = name.rpartition("-")
    return stem if stem in SETS and number.isdigit() else ""


@lru_cache(maxsize=1)
def _folder() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory(prefix="argus-journey-")


def place_of(name: str, key: tuple[int, int], drift_deg_m: float = DRIFT_DEG_M) -> Place:
    """Make the world of this name from a key of numbers, with a course for this drift of the odometry.

    SimError when the name is unknown.
    """
    of = set_of(name)
    if not of and name not in FLOORS:
        raise SimError(f"no world '{name}' for a journey; --rows and --worlds say what there is")
    suffix = "map" if name in FLOORS or of == "pairs" else "yaml"
    path = Path(_folder().name) / f"{name}-{'-'.join(map(str, key))}.{suffix}"
    for attempt in range(_TRIES):
        rng = np.random.default_rng([zlib.crc32(name.encode()), *key, attempt])
        plan, goal = SETS[of](rng) if of else (FLOORS[name](rng), (0.0, 0.0))
        path.write_text(_aria(plan) if suffix == "map" else plan.text(), encoding="utf-8")
        place = _tried(str(path), of, goal, (rng, drift_deg_m))
        if place is not None:
            return place
    raise SimError(f"world {name} of {key}: no plan has a way through it; choose another seed")


def _tried(path: str, of: str, goal: Point, drawn: tuple[Rng, float]) -> Place | None:
    """The place, or None when this plan is none."""
    rng, drift_deg_m = drawn
    try:
        world = load_world(path)
        field = make_field(world)
        if not of:
            if len(field.places(ROOM_MM)) < _PLACES_LEAST:
                return None
            course = drift_course(world, field, rng, drift_deg_m)
            # A rough day leaves no long course between the walls of an office: then its longest is good enough.
            begin = world.start[:2]
            good = (
                length_mm(begin, course) >= LEAST_MM
                and drift_at_goal_mm(begin, course, drift_deg_m) < _OFF_MM
            )
            whole = good or drift_deg_m > DRIFT_DEG_M
            return Place(world, field, path, course, LIMIT_S) if whole else None
    except SimError:
        return None
    if of == "pairs":
        return _pair(world, field, path, rng)
    return (
        Place(world, field, path, (goal,), SET_LIMIT_S) if _is_open(field, goal) != (of == NO_WAY) else None
    )


def _is_open(field: Field, goal: Point) -> bool:
    """Whether the robot gets there with 250 mm beside it, and has room to turn there."""
    places = field.places(ROOM_MM)
    return bool(len(places)) and bool((np.hypot(*(places - np.array(goal)).T) < 80).any())


def _pair(world: World, field: Field, path: str, rng: Rng) -> Place | None:
    """Start and goal in a map with a solid on the straight way between them."""
    places = field.places(ROOM_MM)
    if len(places) < _PLACES_LEAST:
        return None
    for _ in range(_TRIES):
        a, b = places[rng.integers(0, len(places), 2)]
        away = float(np.hypot(*(b - a)))
        if not _PAIR_MM[0] <= away <= _PAIR_MM[1]:
            continue
        start = (float(a[0]), float(a[1]))
        if float(field.leg_clear_mm(start, b[None, :])[0]) < _HALF_MM:
            heading = round(float(rng.uniform(-180, 180)), 1)
            return Place(
                world, field, path, ((float(b[0]), float(b[1])),), SET_LIMIT_S, Pose(*start, heading)
            )
    return None
