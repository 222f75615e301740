# SPDX-License-Identifier: MIT
"""World files: those that come with the emulator, others in our format (docs/worlds.md), and ARIA's."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from hil_sim.arguments import offer
from hil_sim.document import Item, read_document
from hil_sim.errors import SimError
from hil_sim.world.aria_map import load_map
from hil_sim.world.body import BodyModel
from hil_sim.world.builder import MAX_SEGMENTS, Builder, turned
from hil_sim.world.model import POST_SIDES, Pose, World
from hil_sim.world.movers import read_doors, read_people
from hil_sim.world.moving import moving_solids
from hil_sim.world.physics import read_physics

WORLD_DIR: Final = Path(__file__).resolve().parents[1] / "worlds"


def world_names() -> list[str]:
    """Names of the worlds that come with the emulator."""
    return sorted(path.stem for path in WORLD_DIR.glob("*.yaml"))


def load_world(name_or_path: str) -> World:
    """Load a world of ours by name, or a file ending in `.yaml` or (ARIA's) `.map`.

    Raises SimError with file and line when there is none or it is malformed.
    """
    path = Path(name_or_path)
    if path.suffix == ".map":
        return load_map(path)
    if path.suffix in (".yaml", ".yml"):
        return load_yaml(path)
    if name_or_path not in world_names():
        files = "a file ending in .yaml or .map"
        raise SimError(f"no world '{name_or_path}'{offer(name_or_path, world_names(), files)}")
    return load_yaml(WORLD_DIR / f"{name_or_path}.yaml")


_TOP = ("about", "start", "goals", "roughness", "walls", "boxes", "posts", "people", "doors", "physics")


def load_yaml(path: str | Path) -> World:
    """Load a world in our own format."""
    top = read_document(path)
    keys = top.mapping(_TOP)
    build = Builder()
    rough = keys["roughness"].number(0, 1) if "roughness" in keys else 1.0
    for name, add in (("walls", _add_wall), ("boxes", _add_box), ("posts", _add_post)):
        for item in keys[name].items() if name in keys else []:
            add(build, item, rough)
    if len(build.rows) > MAX_SEGMENTS:
        top.fail(f"more than {MAX_SEGMENTS} solids; leave some out")
    values = {name: read(keys[name]) for name, read in _READERS.items() if name in keys}
    movers = (*values.pop("people", ()), *values.pop("doors", ()))
    world = build.world(Path(path).stem, movers=movers, **values)
    _check_start(world, keys.get("start", top))
    return world


def _check_start(world: World, where: Item) -> None:
    if BodyModel(world, moving_solids(world.movers)).contact(world.start, 0.0) is not None:
        where.fail("the robot would start inside a solid; move the start or the solid")


def _need(item: Item, keys: dict[str, Item], *names: str) -> None:
    for name in names:
        if name not in keys:
            item.fail(f"'{name}' is missing; add it")


def _rough(keys: dict[str, Item], default: float) -> float:
    return keys["roughness"].number(0, 1) if "roughness" in keys else default


def _pose(item: Item) -> Pose:
    values = item.numbers(2, 3)
    return Pose(values[0], values[1], values[2] if len(values) == 3 else 0.0)


def _add_wall(build: Builder, item: Item, rough: float) -> None:
    keys = item.mapping(("points", "closed", "roughness"))
    _need(item, keys, "points")
    points = [(x, y) for x, y in (point.numbers(2) for point in keys["points"].items())]
    if len(points) < 2:
        keys["points"].fail("a wall needs two points or more")
    if len(set(points)) == 1:
        keys["points"].fail("all points of the wall are the same; correct them")
    build.line(points, _rough(keys, rough), "closed" in keys and keys["closed"].flag())


def _add_box(build: Builder, item: Item, rough: float) -> None:
    keys = item.mapping(("centre", "size", "turn", "roughness"))
    _need(item, keys, "centre", "size")
    cx, cy = keys["centre"].numbers(2)
    width, depth = keys["size"].numbers(2)
    if width < 1 or depth < 1:
        keys["size"].fail("both sides of a box must be 1 mm or more")
    turn = math.radians(keys["turn"].number(-360, 360)) if "turn" in keys else 0.0
    corners = [
        (-width / 2, -depth / 2),
        (width / 2, -depth / 2),
        (width / 2, depth / 2),
        (-width / 2, depth / 2),
    ]
    points = [(cx + x, cy + y) for x, y in (turned(x, y, turn) for x, y in corners)]
    build.line(points, _rough(keys, rough), closed=True)


def _add_post(build: Builder, item: Item, rough: float) -> None:
    keys = item.mapping(("centre", "diameter", "roughness"))
    _need(item, keys, "centre", "diameter")
    cx, cy = keys["centre"].numbers(2)
    radius = keys["diameter"].number(1, 1e5) / 2
    angles = [2 * math.pi * (k + 0.5) / POST_SIDES for k in range(POST_SIDES)]
    points = [(cx + radius * math.cos(a), cy + radius * math.sin(a)) for a in angles]
    build.line(points, _rough(keys, rough), closed=True)


def _goals(item: Item) -> dict[str, Pose]:
    return {name: _pose(goal) for name, goal in item.named().items()}


_READERS: Final[dict[str, Callable[[Item], Any]]] = {
    "start": _pose,
    "goals": _goals,
    "about": Item.text,
    "people": read_people,
    "doors": read_doors,
    "physics": read_physics,
}
