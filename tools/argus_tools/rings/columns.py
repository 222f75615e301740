# SPDX-License-Identifier: MIT
"""Tables and JSON with a column or key for time, pose and each sonar's range, by their names and units."""

from __future__ import annotations

import json
import math
import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from io import BufferedReader
from itertools import chain, islice
from statistics import median
from typing import Any, Final

from argus_tools.chunks import (
    ROBOT_TO_CLIENT,
    Chunk,
    Damage,
    DamageList,
    LogError,
    Offsets,
    ReadOptions,
)
from argus_tools.rings.motion import Motion
from argus_tools.rings.packet import identity_of
from argus_tools.rings.packets import SIP_S, Pacer
from argus_tools.rings.silence import Silence
from argus_tools.timeline import Item, Timeline
from hil_sim.arcos import frame
from hil_sim.arguments import offer
from hil_sim.tables.robot import DEFAULT_ROBOT, robot_table

LINE_MOST: Final = 1 << 20
SURVEYED: Final = 3000
RANGES_LEAST: Final = 2
SIP_BYTES: Final = 50
"""About as long is the packet that a row becomes."""
MM_LEAST: Final = 30.0
"""A middle range above this is in millimetres: no sonar sees so many metres."""
_UNITS: Final = {
    "mm": 1e-3, "cm": 1e-2, "m": 1.0, "mm_s": 1e-3, "m_s": 1.0, "deg": math.pi / 180, "rad": 1.0,
    "deg_s": math.pi / 180, "rad_s": 1.0, "s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9,
}  # fmt: skip
_UNIT: Final = rf"(?:_({'|'.join(sorted(_UNITS, key=len, reverse=True))}))?"
_KINDS: Final = {
    "t": rf"(?:t|time|timestamp|stamp|secs?|seconds){_UNIT}",
    "x": rf"(?:pos(?:ition|e)?_|odom_)?x{_UNIT}",
    "y": rf"(?:pos(?:ition|e)?_|odom_)?y{_UNIT}",
    "heading": rf"(?:pos(?:ition|e)?_|odom_)?(?:heading|theta|th|yaw){_UNIT}",
    "speed": rf"(?:speed|velocity|vel|v){_UNIT}",
    "turn": rf"(?:turn|turn_rate|rotvel|omega|w){_UNIT}",
    "left": rf"(?:vel_left|left_vel){_UNIT}",
    "right": rf"(?:vel_right|right_vel){_UNIT}",
}
_RANGE: Final = re.compile(rf"(?:sonars?|ranges?|us|ultrasonic|distances?|dist)_?(\d+){_UNIT}")
_EPOCH_S: Final = 1e11
"""A time since 1970 above it is in milliseconds or finer; each step of 1,000 is one more."""


@dataclass(frozen=True)
class Columns:
    """Which column is what: its name, and its unit in s, m, rad; None where the name has none."""

    known: dict[str, tuple[str, float | None]]
    ranges: dict[int, tuple[str, float | None]]

    @property
    def is_ring(self) -> bool:
        """Whether these are the readings of a ring over time."""
        return "t" in self.known and len(self.ranges) >= RANGES_LEAST


def _plain(name: str) -> str:
    return re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_")


def is_understood(name: str) -> bool:
    """Whether a column of this name is one of a ring's.

    >>> is_understood("sonar_3_mm"), is_understood("voltage")
    (True, False)
    """
    columns = understood([name])
    return bool(columns.known or columns.ranges)


def understood(names: list[str], given: Mapping[str, str] | None = None) -> Columns:
    """Return what columns of these names are. given: the columns that stand for another name, which come first."""
    known: dict[str, tuple[str, float | None]] = {}
    found: dict[int, tuple[str, float | None]] = {}
    given = given or {}
    for name in sorted(names, key=lambda name: name not in given):
        plain = _plain(given.get(name, name))
        if match := _RANGE.fullmatch(plain):
            found.setdefault(int(match[1]), (name, _UNITS.get(match[2] or "")))
            continue
        for kind, pattern in _KINDS.items():
            if kind not in known and (match := re.fullmatch(pattern, plain)):
                known[kind] = name, _UNITS.get(match[1] or "")
    first = 1 if found and 0 not in found and max(found) == len(found) else 0
    return Columns(known, {number - first: column for number, column in found.items()})


def flat(value: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the leaves of a JSON value with the names of their way: sonar_3 of {"sonar": {"3": 706}}."""
    if isinstance(value, dict):
        pairs: Any = value.items()
    elif isinstance(value, list):
        pairs = enumerate(value)
    else:
        yield name, value
        return
    for key, inner in pairs:
        yield from flat(inner, f"{name}_{key}" if name else str(key))


def separator_of(line: str) -> str:
    """Return what parts the cells of a line of headings."""
    return max(",;\t", key=line.count)


Row = tuple[int, dict[str, Any]]


def table_rows(stream: BufferedReader, damage: DamageList) -> Iterator[Row]:
    """Yield the rows of a table below its headings, with the numbers of their lines."""
    names: list[str] = []
    separator = ","
    for number, raw in enumerate(iter(lambda: stream.readline(LINE_MOST), b""), 1):
        line = raw.decode("utf-8", "replace").strip("\r\n\ufeff")
        if not line.strip() or line.startswith("#"):
            continue
        if not names:
            separator = separator_of(line)
            names = [cell.strip().strip('"') for cell in line.split(separator)]
            continue
        cells = [cell.strip().strip('"') for cell in line.split(separator)]
        if len(cells) < len(names):
            damage.append(Damage(f"line {number}", f"{len(cells)} cells, but {len(names)} headings"))
            continue
        if separator == ";":
            cells = [cell.replace(",", ".") for cell in cells]
        yield number, dict(zip(names, cells, strict=False))


def json_rows(stream: BufferedReader, damage: DamageList) -> Iterator[Row]:
    """Yield the objects of JSON lines, flat."""
    for number, raw in enumerate(iter(lambda: stream.readline(LINE_MOST), b""), 1):
        line = raw.strip().rstrip(b",")
        if not line:
            continue
        try:
            value = json.loads(line)
        except ValueError:
            damage.append(Damage(f"line {number}", "no JSON"))
            continue
        if isinstance(value, dict):
            yield number, dict(flat(value))


def number_of(cell: Any) -> float:
    """Return a cell as a number; NaN where it is empty or none."""
    if cell is None or cell == "" or isinstance(cell, bool):
        return math.nan
    try:
        return float(cell)
    except (TypeError, ValueError):
        return math.nan


class ColumnsLog:
    """The reader: a packet for each row."""

    def __init__(self, rows: Iterator[Row], options: ReadOptions, damage: DamageList) -> None:
        self.damage = damage
        self.place = ""
        self._rows, self._options = rows, options
        self._table = robot_table(options.subclass or DEFAULT_ROBOT)

    def __iter__(self) -> Iterator[Chunk]:
        head = list(islice(self._rows, SURVEYED))
        names = list(dict.fromkeys(name for _, row in head for name in row))
        for meaning, name in self._options.columns:
            if name not in names:
                given = f"{self._options.name}: --columns {meaning}={name}: no such column"
                raise LogError(given + offer(name, names))
        columns = understood(names, {name: meaning for meaning, name in self._options.columns})
        if not columns.is_ring:
            raise LogError(
                f"{self._options.name}: no columns of time and ranges: t_s, x_m, y_m, heading_deg, sonar_0_m; "
                "--columns t_s=NAME,sonar_0_mm=NAME says which they are"
            )
        if max(columns.ranges) >= self._table.sonars:
            raise LogError(
                f"{self._options.name}: a range of sonar {max(columns.ranges)}, but {self._table.subclass} has "
                f"{self._table.sonars} sonars; --subclass names another robot"
            )
        reader = Reading(columns, head, self._table.motion["track_mm"])
        silence = Silence(self._table.no_echo_mm, self._table.min_mm)
        present = set()
        for _, row in head:
            for number, range_m in reader.ranges(row).items():
                silence.note(number, range_m)
                present.add(number)
        no_echo = silence.settle()
        self._options.absent = frozenset(range(self._table.sonars)) - present
        self._options.tell(
            f"ranges: {len(present)} columns, in {reader.unit_name}, ring of {self._table.subclass}"
        )
        self._options.tell(no_echo)
        if not {"x", "y", "heading"} <= columns.known.keys():
            self._options.tell(
                "no columns of a pose: the robot is taken to be at rest, where nothing is cross-checked"
            )
        yield from self._chunks(chain(head, self._rows), reader, silence)

    def _chunks(self, rows: Iterator[Row], reader: Reading, silence: Silence) -> Iterator[Chunk]:
        offsets, last, motion = Offsets(), -math.inf, Motion()
        discarded: Counter[str] = Counter()
        pacer = Pacer(self._table, True, lambda _: motion)
        stands = False
        for item in Timeline(_items(rows, reader), self.damage):
            self.place, row = item.place, item.body
            ranges = reader.ranges(row)
            place = reader.motion(row)
            if not ranges and place is None:
                continue
            stood, stands = stands, item.t is None
            t = item.t
            if t is None:
                t = last + SIP_S if math.isfinite(last) else 0.0
            if stood and not stands:
                last = min(last, t - SIP_S)  # which was reckoned while the clock stood
            if last - 1.0 < t <= last:
                discarded["row that is not newer than the last"] += 1
                continue
            made = pacer.due(t)
            motion = reader.moving(place, motion, t - last) if place is not None else motion
            last = t
            made += pacer.take(t, {k: silence.millimetres(range_m) for k, range_m in ranges.items()})
            for at, data in made:
                when = None if stands else at
                if not offsets.at[ROBOT_TO_CLIENT]:
                    yield offsets.chunk(when, ROBOT_TO_CLIENT, frame(identity_of(self._table).data))
                yield offsets.chunk(when, ROBOT_TO_CLIENT, data)
        for what, count in discarded.items():
            self._options.tell(f"discarded: {count} x {what}")


def _items(rows: Iterator[Row], reader: Reading) -> Iterator[Item[dict[str, Any]]]:
    """Yield rows with their times, each in place of the packet that it becomes."""
    for number, row in rows:
        t = reader.time(row)
        if math.isfinite(t):
            yield Item(t, bytes(SIP_BYTES), f"line {number}", row)


class Reading:
    """Rows as numbers in s, m and rad; units that no name tells are seen from the data."""

    def __init__(self, columns: Columns, head: list[Row], track_mm: float) -> None:
        self._columns, self._track_m = columns, track_mm / 1000
        values = [
            value
            for _, row in head
            for name, _ in columns.ranges.values()
            if math.isfinite(value := number_of(row.get(name))) and value > 0
        ]
        self._range_unit = 1e-3 if values and median(values) > MM_LEAST else 1.0
        units = {unit if unit is not None else self._range_unit for _, unit in columns.ranges.values()}
        self.unit_name = " and ".join(
            "mm" if unit == 1e-3 else "cm" if unit == 1e-2 else "m" for unit in sorted(units)
        )
        times = [number_of(row.get(columns.known["t"][0])) for _, row in head]
        greatest = max((t for t in times if math.isfinite(t)), default=0.0)
        self._time_unit = 1.0
        while greatest * self._time_unit > _EPOCH_S and columns.known["t"][1] is None:
            self._time_unit /= 1000

    def _value(self, row: Mapping[str, Any], kind: str, default: float = 1.0) -> float:
        if kind not in self._columns.known:
            return math.nan
        name, unit = self._columns.known[kind]
        return number_of(row.get(name)) * (default if unit is None else unit)

    def time(self, row: Mapping[str, Any]) -> float:
        """Return the time of a row, s."""
        return self._value(row, "t", self._time_unit)

    def ranges(self, row: Mapping[str, Any]) -> dict[int, float]:
        """Return the ranges of a row, m; an empty cell is none."""
        found = {}
        for number, (name, unit) in self._columns.ranges.items():
            if row.get(name) not in (None, ""):
                found[number] = number_of(row[name]) * (self._range_unit if unit is None else unit)
        return found

    def motion(self, row: Mapping[str, Any]) -> Motion | None:
        """Return pose and speeds of a row, NaN for speeds that it has not; None where it has no pose."""
        pose = [self._value(row, kind) for kind in ("x", "y", "heading")]
        if not all(map(math.isfinite, pose)):
            return None
        speed, turn = self._value(row, "speed"), self._value(row, "turn")
        left, right = self._value(row, "left"), self._value(row, "right")
        if math.isfinite(left + right):
            speed, turn = (left + right) / 2, (right - left) / self._track_m
        x_m, y_m, heading_rad = pose
        return Motion(x_m, y_m, heading_rad, speed, turn)

    def moving(self, place: Motion, before: Motion, passed_s: float) -> Motion:
        """Return a motion with speeds: its own, else those that brought it here."""
        if math.isfinite(place.speed_m_s + place.turn_rad_s):
            return place
        return Motion(place.x_m, place.y_m, place.heading_rad).since(before, passed_s)
