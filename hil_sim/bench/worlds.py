# SPDX-License-Identifier: MIT
"""Worlds made from a seed: rooms with furniture, glass walls, corridors, halls, offices and clutter, as YAML text."""

from __future__ import annotations

import math
import zlib
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np
import yaml

from hil_sim.arguments import offer
from hil_sim.bench.course import ROOM_MM, SWING_MM, Field, make_field
from hil_sim.errors import SimError
from hil_sim.world.files import load_yaml
from hil_sim.world.model import World

Rng = np.random.Generator
_TRIES: Final = 50
_FREE_CELLS: Final = 400
"""Cells of 50 mm where a waypoint may lie: one square metre, or the plan is thrown away."""


@dataclass
class Plan:
    """What a world is made of, in the terms of docs/worlds.md; the start is the origin."""

    about: str
    roughness: float
    walls: list[dict[str, Any]] = field(default_factory=list)
    boxes: list[dict[str, Any]] = field(default_factory=list)
    posts: list[dict[str, Any]] = field(default_factory=list)

    def outline(self, left: float, low: float, right: float, high: float) -> None:
        """Add the four walls of a room."""
        points = [[left, low], [right, low], [right, high], [left, high]]
        self.walls.append({"points": [[round(x), round(y)] for x, y in points], "closed": True})

    def wall(self, *points: tuple[float, float]) -> None:
        """Add a wall."""
        self.walls.append({"points": [[round(x), round(y)] for x, y in points]})

    def text(self) -> str:
        """Return the world's file."""
        plain: dict[str, Any] = {"about": self.about, "start": [0, 0, 0], "roughness": self.roughness}
        plain |= {name: getattr(self, name) for name in ("walls", "boxes", "posts") if getattr(self, name)}
        return "# SPDX-License-Identifier: MIT\n" + yaml.safe_dump(plain, sort_keys=False, width=100)


def _furnish(plan: Plan, rng: Rng, room: tuple[float, float, float, float], boxes: int, posts: int) -> None:
    """Put furniture somewhere in a room, away from the start."""
    left, low, right, high = room
    for k in range(boxes + posts):
        x, y = float(rng.uniform(left, right)), float(rng.uniform(low, high))
        width, depth = float(rng.uniform(300, 1500)), float(rng.uniform(300, 900))
        # Along a wall half of the time, as furniture stands.
        if rng.random() < 0.5:
            y = low + depth / 2 if rng.random() < 0.5 else high - depth / 2
            turn = 0.0
        else:
            turn = float(rng.choice([0.0, 0.0, rng.uniform(-45, 45)]))
        if math.hypot(x, y) < ROOM_MM + math.hypot(width, depth) / 2 + 100:
            continue
        centre, rough = [round(x), round(y)], round(float(rng.choice([0.5, 0.8, 1.0])), 2)
        if k < boxes:
            size = [round(width), round(depth)]
            plan.boxes.append({"centre": centre, "size": size, "turn": round(turn, 1), "roughness": rough})
        else:
            plan.posts.append(
                {"centre": centre, "diameter": round(float(rng.uniform(40, 120))), "roughness": rough}
            )


def _inside(rng: Rng, width: float, depth: float) -> tuple[float, float, float, float]:
    """A room of this size round the start, which is clear of its walls."""
    margin = SWING_MM + 400
    left = -float(rng.uniform(margin, width - margin))
    low = -float(rng.uniform(margin, depth - margin))
    return left, low, left + width, low + depth


def _room(rng: Rng) -> Plan:
    plan = Plan("A furnished room.", round(float(rng.uniform(0.4, 1.0)), 2))
    room = _inside(rng, float(rng.uniform(3800, 9000)), float(rng.uniform(3600, 8000)))
    plan.outline(*room)
    _furnish(plan, rng, room, int(rng.integers(1, 7)), int(rng.integers(0, 4)))
    return plan


def _glass(rng: Rng) -> Plan:
    plan = Plan("A room with walls as smooth as glass.", round(float(rng.uniform(0.0, 0.15)), 2))
    room = _inside(rng, float(rng.uniform(3600, 8000)), float(rng.uniform(3600, 7000)))
    plan.outline(*room)
    _furnish(plan, rng, room, int(rng.integers(0, 4)), int(rng.integers(0, 3)))
    return plan


def _corridor(rng: Rng) -> Plan:
    plan = Plan("A corridor with recesses and columns.", round(float(rng.uniform(0.3, 0.8)), 2))
    half, end = float(rng.uniform(850, 1500)), float(rng.uniform(7000, 16000))
    top: list[tuple[float, float]] = []
    x = float(rng.uniform(0, 1500))
    while x + 900 < end - 600:
        deep = half + float(rng.uniform(150, 350))
        top += [(x, half), (x, deep), (x + 900, deep), (x + 900, half)]
        x += float(rng.uniform(2200, 4500))
    plan.wall((-1500, half), *top, (end, half), (end, -half), (-1500, -half), (-1500, half))
    for _ in range(int(rng.integers(0, 3))):
        side, along = float(rng.choice([-1, 1])), float(rng.uniform(2000, end - 1000))
        centre = [round(along), round(side * (half - 120))]
        plan.boxes.append({"centre": centre, "size": [240, 240], "roughness": 1.0})
    return plan


def _hall(rng: Rng) -> Plan:
    plan = Plan("An open hall.", round(float(rng.uniform(0.4, 1.0)), 2))
    room = _inside(rng, float(rng.uniform(13000, 26000)), float(rng.uniform(12000, 20000)))
    plan.outline(*room)
    _furnish(plan, rng, room, int(rng.integers(0, 5)), int(rng.integers(0, 5)))
    return plan


def _office(rng: Rng) -> Plan:
    plan = Plan("Rooms side by side with doors between them.", round(float(rng.uniform(0.4, 0.9)), 2))
    depth = float(rng.uniform(3600, 6000))
    low = -depth * float(rng.uniform(0.35, 0.65))
    high = low + depth
    x = left = -float(rng.uniform(1200, 2200))
    walls = []
    for _ in range(int(rng.integers(2, 5))):
        right = x + float(rng.uniform(3200, 5000))
        _furnish(plan, rng, (x, low, right, high), int(rng.integers(1, 4)), int(rng.integers(0, 3)))
        walls.append(right)
        x = right
    plan.outline(left, low, x, high)
    for at in walls[:-1]:
        half = float(rng.uniform(500, 700))
        door = float(rng.uniform(low + half + 200, high - half - 200))
        plan.wall((at, low), (at, door - half))
        plan.wall((at, door + half), (at, high))
    return plan


def _clutter(rng: Rng) -> Plan:
    plan = Plan("A store room full of boxes and posts.", round(float(rng.uniform(0.6, 1.0)), 2))
    room = _inside(rng, float(rng.uniform(6000, 10000)), float(rng.uniform(6000, 9000)))
    plan.outline(*room)
    _furnish(plan, rng, room, int(rng.integers(5, 11)), int(rng.integers(3, 9)))
    return plan


_MAKERS: Final[dict[str, Callable[[Rng], Plan]]] = {
    "gen-room": _room,
    "gen-glass": _glass,
    "gen-corridor": _corridor,
    "gen-hall": _hall,
    "gen-office": _office,
    "gen-clutter": _clutter,
}
GENERATED: Final = tuple(_MAKERS)
OPEN: Final = ("hall", "gen-hall")
"""Worlds that are no rooms: from their middle nothing is in range."""


def make_world(name: str, key: tuple[int, ...], folder: Path) -> tuple[World, Field, Path]:
    """Make the world of this name from a key of numbers; its file goes into `folder`.

    Raises SimError when the name is unknown. A plan without room to drive in is thrown away for the next one.
    """
    if name not in _MAKERS:
        raise SimError(f"no generated world '{name}'{offer(name, GENERATED)}")
    path = folder / f"{name}-{'-'.join(map(str, key))}.yaml"
    for attempt in range(_TRIES):
        plan = _MAKERS[name](np.random.default_rng([zlib.crc32(name.encode()), *key, attempt]))
        path.write_text(plan.text(), encoding="utf-8")
        try:
            world = load_yaml(path)
        except SimError:
            continue
        measured = make_field(world)
        if len(measured.places(ROOM_MM)) >= _FREE_CELLS:
            return world, measured, path
    raise SimError(f"world {name} of {key}: no plan has room to drive in; choose another seed")
