# SPDX-License-Identifier: MIT
"""ARIA `.map` files."""

from __future__ import annotations

import logging
import math
import re
from pathlib import Path
from typing import Final, NoReturn

import numpy as np

from hil_sim.document import read_text
from hil_sim.errors import SimError
from hil_sim.world.builder import MAX_SEGMENTS, Builder, turned
from hil_sim.world.model import Pose, World

POINT_MM: Final = 20.0
"""Side of the solid that stands for one DATA point of a map, and the grid onto which such points are thinned."""
MAP_ROUGHNESS: Final = 0.5
_LOG: Final = logging.getLogger("argus.sim")
_HEADERS = ("2D-Map", "2D-Map-Ex", "2D-Map-Ex2")
_NEWER = re.compile(r"2D-Map-Ex[0-9]+")
_CAIRN = re.compile(r'(\S+)\s+(\S+)\s+(\S+)\s+(\S+)\s+"[^"]*"\s+\S+\s+"([^"]*)"\s*(.*)$')
_SECTION = re.compile(r"(?:(?P<sensor>\S+)_)?(?P<what>LINES|DATA)")
_COUNT = re.compile(r"(?P<what>\w*Num(?:Lines|Points)):(?P<count>.*)")
_NUMBERS = re.compile(r"[-+0-9.]+[\s,]")
_AREAS = ("ForbiddenLine", "ForbiddenArea", "Sim.BoxObstacle")


class _MapReader:
    """Reads one `.map` file line by line."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.number = 0
        self.build = Builder()
        self.points: set[tuple[int, int]] = set()
        self.start: Pose | None = None
        self.goals: dict[str, Pose] = {}
        self.forbidden: list[tuple[float, float, float, float]] = []
        self.announced: dict[str, tuple[str, int]] = {}
        self.counted: dict[str, int] = {}
        self.told: set[str] = set()

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
        lines = read_text(self.path, self.warn_of_latin_1).splitlines()
        first = self.take_form(lines)
        section = what = ""
        for self.number, raw in enumerate(lines[first:], first + 1):
            line = self.without_comment(raw.strip())
            if match := _SECTION.fullmatch(line):
                section = match["what"]
                what = (match["sensor"] or "") + ("NumLines" if section == "LINES" else "NumPoints")
            elif section and line:
                self.counted[what] = self.counted.get(what, 0) + 1
                self.take_entry(section, line)
            elif line:
                self.take_header(line)
            self.check_size()
        self.check_counts()
        self.add_points()
        return self.finish()

    def warn(self, what: str) -> None:
        """Tell of what is odd in the current line, and go on."""
        _LOG.warning("%s:%d: %s", self.path, self.number, what)

    def warn_once(self, what: str) -> None:
        """Tell of what may be odd in many lines, at the first of them."""
        if what not in self.told:
            self.told.add(what)
            self.warn(what)

    def without_comment(self, line: str) -> str:
        """Return a line as far as it is of a map; a name of a Cairn may have the mark of a comment in it."""
        if "#" not in line or not (line.startswith("#") or _NUMBERS.match(line)):
            return line
        self.warn_once("a comment (#), which a map has not: passed over, here and below")
        return line.partition("#")[0].rstrip()

    def warn_of_latin_1(self, byte: int) -> None:
        """Tell that names may come out wrong."""
        _LOG.warning("%s: not UTF-8 (byte %d): read as Latin-1; save it as UTF-8", self.path, byte)

    def take_form(self, lines: list[str]) -> int:
        """Check the first line that is no comment; return how many lines there are up to it."""
        for self.number, raw in enumerate(lines, 1):
            if line := self.without_comment(raw.strip().lstrip("\ufeff")):
                self.check_form(line)
                return self.number
        self.number = 1
        self.check_form("")
        return 1

    def check_form(self, form: str) -> None:
        """Refuse what is no map; a newer form is read as the newest that is known."""
        if form in _HEADERS:
            return
        if not _NEWER.fullmatch(form):
            self.fail("not an ARIA map: the first line must be 2D-Map, 2D-Map-Ex or 2D-Map-Ex2")
        self.warn(f"{form} is a form that is not known: read as {_HEADERS[-1]}")

    def take_header(self, line: str) -> None:
        """Use a line before the first section, if it matters here."""
        if match := _COUNT.match(line):
            self.take_count(match["what"], match["count"].strip())
        elif line.split()[0] == "Cairn:":
            self.take_cairn(line[len("Cairn:") :].strip())
        elif ":" not in line:
            self.fail(f"'{line[:40]}' is neither a header line nor LINES or DATA; correct or remove it")

    def take_count(self, what: str, count: str) -> None:
        """Note how many entries the header announces, whatever stands there."""
        self.announced[what] = (count, self.number)

    def check_counts(self) -> None:
        """Tell of counts that do not fit, as after editing by hand; of what was announced something must be there."""
        for what, (text, line) in self.announced.items():
            found = self.counted.get(what, 0)
            self.number = line
            if not re.fullmatch("[0-9]{1,9}", text):
                self.check_no_count(what, text[:60], found)
                continue
            count = int(text)
            if found == 0 < count:
                self.fail(f"{what} announces {count} but none follow; restore the file or correct the count")
            if found != count:
                cut = "; was the file cut short?" if found < count else ""
                self.warn(f"{what} announces {count} but {found} follow: those are read{cut}")

    def check_no_count(self, what: str, text: str, found: int) -> None:
        """Tell of a count that is no number; the entries themselves say how many they are."""
        if not found:
            self.fail(
                f"{what} needs a whole number, not '{text}', and none follow; correct or remove the line"
            )
        self.warn(f"{what} needs a whole number, not '{text}': the {found} that follow are read")

    def check_size(self) -> None:
        """Refuse a map too large to be simulated before it fills the memory."""
        if len(self.build.rows) + 2 * len(self.points) > MAX_SEGMENTS:
            self.fail(f"more than {MAX_SEGMENTS} solids; use a map with lines, or fewer DATA points")

    def take_entry(self, section: str, line: str) -> None:
        """Add a line, or note a DATA point on a grid of POINT_MM."""
        if "," in line:
            self.warn_once("commas between the numbers, which a map has not: read as spaces, here and below")
            line = line.replace(",", " ")
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
            self.forbidden.append((*turned(x1, y1, turn), *turned(x2, y2, turn)))
            return
        points = [turned(x, y, turn) for x, y in ((x1, y1), (x2, y1), (x2, y2), (x1, y2))]
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
