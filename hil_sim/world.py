# SPDX-License-Identifier: MIT
"""Worlds: solid line segments with a roughness, a start and goals, from our YAML files or ARIA `.map` files."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, NamedTuple, NoReturn

import numpy as np
import numpy.typing as npt

from hil_sim.document import Item, read_document, read_text
from hil_sim.errors import SimError
from hil_sim.movers import Mover, read_doors, read_people

Floats = npt.NDArray[np.float64]

WORLD_DIR: Final = Path(__file__).resolve().parent / "worlds"
POST_SIDES: Final = 8
POINT_MM: Final = 20.0
"""Side of the solid that stands for one DATA point of a map, and the grid onto which such points are thinned."""
MAP_ROUGHNESS: Final = 0.5
MAX_SEGMENTS: Final = 200_000
_SHORTEST_MM: Final = 1e-3
"""Two points nearer than this are one."""


class Pose(NamedTuple):
    """A place and a heading: mm, degrees counter-clockwise from the world's x axis."""

    x_mm: float
    y_mm: float
    heading_deg: float


ORIGIN: Final = Pose(0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class World:
    """What is around the robot.

    segments: N x 4, x1 y1 x2 y2 in mm. roughness: N, 0 smooth (mirrors sound) to 1 rough (scatters it back).
    goals: places by name. forbidden: N x 4, lines that a map asks a planner to keep away from; not solid.
    movers: people and doors, which are not among the segments.
    """

    name: str
    segments: Floats
    roughness: Floats
    start: Pose = ORIGIN
    goals: dict[str, Pose] = field(default_factory=dict)
    about: str = ""
    forbidden: Floats = field(default_factory=lambda: np.zeros((0, 4)))
    movers: tuple[Mover, ...] = ()

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest x, smallest y, largest x, largest y of the solids and the start."""
        xs = np.append(self.segments[:, 0::2].ravel(), self.start.x_mm)
        ys = np.append(self.segments[:, 1::2].ravel(), self.start.y_mm)
        return float(xs.min()), float(ys.min()), float(xs.max()), float(ys.max())


class _Builder:
    """Collects segments while a file is read."""

    def __init__(self) -> None:
        self.rows: list[tuple[float, float, float, float]] = []
        self.rough: list[float] = []

    def line(self, points: list[tuple[float, float]], roughness: float, closed: bool = False) -> None:
        """Add the segments between consecutive points."""
        ends = points[1:] + points[:1] if closed else points[1:]
        for (x1, y1), (x2, y2) in zip(points, ends, strict=False):
            if math.hypot(x2 - x1, y2 - y1) > _SHORTEST_MM:
                self.rows.append((x1, y1, x2, y2))
                self.rough.append(roughness)

    def world(self, name: str, **rest: object) -> World:
        """Make the world."""
        segments = np.array(self.rows, dtype=np.float64).reshape(-1, 4)
        return World(name, segments, np.array(self.rough, dtype=np.float64), **rest)  # type: ignore[arg-type]


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
        raise SimError(
            f"no world '{name_or_path}'; name one of {', '.join(world_names())}, or a file ending in .yaml or .map"
        )
    return load_yaml(WORLD_DIR / f"{name_or_path}.yaml")


# ---- our own format (docs/worlds.md) --------------------------------------------------------------------------

_TOP = ("about", "start", "goals", "roughness", "walls", "boxes", "posts", "people", "doors")


def load_yaml(path: str | Path) -> World:
    """Load a world in our own format."""
    top = read_document(path)
    keys = top.mapping(_TOP)
    build = _Builder()
    rough = keys["roughness"].number(0, 1) if "roughness" in keys else 1.0
    for wall in keys["walls"].items() if "walls" in keys else []:
        _add_wall(build, wall, rough)
    for box in keys["boxes"].items() if "boxes" in keys else []:
        _add_box(build, box, rough)
    for post in keys["posts"].items() if "posts" in keys else []:
        _add_post(build, post, rough)
    start = _pose(keys["start"]) if "start" in keys else Pose(0.0, 0.0, 0.0)
    goals = {name: _pose(item) for name, item in keys["goals"].named().items()} if "goals" in keys else {}
    about = keys["about"].text() if "about" in keys else ""
    if len(build.rows) > MAX_SEGMENTS:
        top.fail(f"more than {MAX_SEGMENTS} solids; leave some out")
    people = read_people(keys["people"]) if "people" in keys else ()
    doors = read_doors(keys["doors"]) if "doors" in keys else ()
    world = build.world(Path(path).stem, start=start, goals=goals, about=about, movers=(*people, *doors))
    _check_start(world, keys.get("start", top))
    return world


def _check_start(world: World, where: Item) -> None:
    from hil_sim.body import BodyModel
    from hil_sim.moving import moving_solids

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


def _add_wall(build: _Builder, item: Item, rough: float) -> None:
    keys = item.mapping(("points", "closed", "roughness"))
    _need(item, keys, "points")
    points = [(x, y) for x, y in (point.numbers(2) for point in keys["points"].items())]
    if len(points) < 2:
        keys["points"].fail("a wall needs two points or more")
    if len(set(points)) == 1:
        keys["points"].fail("all points of the wall are the same; correct them")
    build.line(points, _rough(keys, rough), "closed" in keys and keys["closed"].flag())


def _add_box(build: _Builder, item: Item, rough: float) -> None:
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
    points = [(cx + x, cy + y) for x, y in (_turned(x, y, turn) for x, y in corners)]
    build.line(points, _rough(keys, rough), closed=True)


def _add_post(build: _Builder, item: Item, rough: float) -> None:
    keys = item.mapping(("centre", "diameter", "roughness"))
    _need(item, keys, "centre", "diameter")
    cx, cy = keys["centre"].numbers(2)
    radius = keys["diameter"].number(1, 1e5) / 2
    angles = [2 * math.pi * (k + 0.5) / POST_SIDES for k in range(POST_SIDES)]
    points = [(cx + radius * math.cos(a), cy + radius * math.sin(a)) for a in angles]
    build.line(points, _rough(keys, rough), closed=True)


def _turned(x: float, y: float, angle: float) -> tuple[float, float]:
    c, s = math.cos(angle), math.sin(angle)
    return x * c - y * s, x * s + y * c


# ---- ARIA maps --------------------------------------------------------------------------------------------------

_HEADERS = ("2D-Map", "2D-Map-Ex", "2D-Map-Ex2")
_CAIRN = re.compile(r'(\S+)\s+(\S+)\s+(\S+)\s+(\S+)\s+"[^"]*"\s+\S+\s+"([^"]*)"\s*(.*)$')
_SECTION = re.compile(r"(?:(?P<sensor>\S+)_)?(?P<what>LINES|DATA)")
_COUNT = re.compile(r"(?P<what>\w*Num(?:Lines|Points)):(?P<count>.*)")
_AREAS = ("ForbiddenLine", "ForbiddenArea", "Sim.BoxObstacle")


class _MapReader:
    """Reads one `.map` file line by line."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.number = 0
        self.build = _Builder()
        self.points: set[tuple[int, int]] = set()
        self.start: Pose | None = None
        self.goals: dict[str, Pose] = {}
        self.forbidden: list[tuple[float, float, float, float]] = []
        self.announced: dict[str, tuple[int, int]] = {}
        self.counted: dict[str, int] = {}

    def fail(self, what: str) -> NoReturn:
        """Refuse the current line."""
        raise SimError(f"{self.path}:{self.number}: {what}")

    def values(self, text: str, count: int, what: str) -> list[float]:
        """Return exactly `count` finite numbers."""
        try:
            values = [float(word) for word in text.split()]
        except ValueError:
            values = []
        if len(values) != count or not all(math.isfinite(v) and abs(v) < 1e7 for v in values):
            self.fail(f"{what} needs {count} numbers in mm, not '{text[:60]}'; correct or remove the line")
        return values

    def read(self) -> World:
        """Read the file and return its world."""
        lines = read_text(self.path).splitlines()
        self.number = 1
        if not lines or lines[0].strip().lstrip("\ufeff") not in _HEADERS:
            self.fail("not an ARIA map: the first line must be 2D-Map, 2D-Map-Ex or 2D-Map-Ex2")
        section = what = ""
        for self.number, raw in enumerate(lines[1:], 2):
            line = raw.strip()
            word = line.split()[0] if line else ""
            if match := _SECTION.fullmatch(line):
                section = match["what"]
                what = (match["sensor"] or "") + ("NumLines" if section == "LINES" else "NumPoints")
            elif section and word:
                self.counted[what] = self.counted.get(what, 0) + 1
                self.take_entry(section, line)
            elif match := _COUNT.match(line):
                self.take_count(match["what"], match["count"].strip())
            elif word == "Cairn:":
                self.take_cairn(line[len("Cairn:") :].strip())
            elif word and ":" not in line:
                self.fail(f"'{line[:40]}' is neither a header line nor LINES or DATA; correct or remove it")
            self.check_size()
        self.check_counts()
        self.add_points()
        return self.finish()

    def take_count(self, what: str, count: str) -> None:
        """Note how many entries the header announces."""
        if not re.fullmatch("[0-9]{1,9}", count):
            self.fail(f"{what} needs a whole number, not '{count[:60]}'; correct or remove the line")
        self.announced[what] = (int(count), self.number)

    def check_counts(self) -> None:
        """Refuse a file that was cut short; more than announced is common after editing by hand, and harmless."""
        for what, (count, line) in self.announced.items():
            found = self.counted.get(what, 0)
            if found < count:
                self.number = line
                self.fail(
                    f"{what} announces {count} but {found} follow; restore the file or correct the count"
                )

    def check_size(self) -> None:
        """Refuse a map too large to be simulated before it fills the memory."""
        if len(self.build.rows) + 2 * len(self.points) > MAX_SEGMENTS:
            self.fail(f"more than {MAX_SEGMENTS} solids; use a map with lines, or fewer DATA points")

    def take_entry(self, section: str, line: str) -> None:
        """Add a line, or note a DATA point on a grid of POINT_MM."""
        if section == "LINES":
            x1, y1, x2, y2 = self.values(line, 4, "a line")
            self.build.line([(x1, y1), (x2, y2)], MAP_ROUGHNESS)
            return
        x, y = self.values(line, 2, "a DATA point")
        self.points.add((round(x / POINT_MM), round(y / POINT_MM)))

    def add_points(self) -> None:
        """Turn each noted point into a small cross, solid from every side."""
        half = POINT_MM / 2
        for column, row in sorted(self.points):
            x, y = column * POINT_MM, row * POINT_MM
            self.build.line([(x - half, y - half), (x + half, y + half)], 1.0)
            self.build.line([(x - half, y + half), (x + half, y - half)], 1.0)

    def take_cairn(self, text: str) -> None:
        """Use a Cairn line of a kind that matters here; others are passed over."""
        kind = text.split()[0] if text else ""
        if kind not in _AREAS and kind not in ("RobotHome", "Goal", "GoalWithHeading", "Dock"):
            return
        match = _CAIRN.match(text)
        if match is None:
            self.fail(f'expected Cairn: {kind} X Y HEADING "" ICON "NAME" ...; correct or remove the line')
        x, y, heading = self.values(" ".join(match.group(2, 3, 4)), 3, f"Cairn {kind}")
        if kind == "RobotHome":
            if self.start is None:
                self.start = Pose(x, y, heading)
        elif kind in _AREAS:
            self.take_area(kind, math.radians(heading), self.values(match[6], 4, f"Cairn {kind}"))
        else:
            self.goals[match[5] or f"goal {len(self.goals) + 1}"] = Pose(x, y, heading)

    def take_area(self, kind: str, turn: float, corners: list[float]) -> None:
        """Corners are given in axes turned about the map's origin by the object's heading."""
        x1, y1, x2, y2 = corners
        if kind == "ForbiddenLine":
            self.forbidden.append((*_turned(x1, y1, turn), *_turned(x2, y2, turn)))
            return
        points = [_turned(x, y, turn) for x, y in ((x1, y1), (x2, y1), (x2, y2), (x1, y2))]
        if kind == "Sim.BoxObstacle":
            self.build.line(points, MAP_ROUGHNESS, closed=True)
        else:
            self.forbidden += [(*a, *b) for a, b in zip(points, points[1:] + points[:1], strict=True)]

    def finish(self) -> World:
        """Make the world; without a RobotHome the robot starts at the origin."""
        return self.build.world(
            self.path.stem,
            start=self.start or Pose(0.0, 0.0, 0.0),
            goals=self.goals,
            about=f"ARIA map {self.path.name}",
            forbidden=np.array(self.forbidden, dtype=np.float64).reshape(-1, 4),
        )


def load_map(path: str | Path) -> World:
    """Load an ARIA `.map` file; raises SimError with file and line when it is malformed."""
    return _MapReader(Path(path)).read()
