# SPDX-License-Identifier: MIT
"""What Nav2 does with ranges, as its documentation says: the range layer of the costmap, and the collision monitor.

Sources: "Range Sensor Parameters" and "Collision Monitor Node" of docs.nav2.org (parameters and defaults), the
README of nav2_collision_monitor, and the behaviour of both in ros-navigation/navigation2 at a3a97043.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

FREE, UNKNOWN, LETHAL = 0, 255, 254
_SCALE = 254
_WIDEST_RAD = math.pi


@dataclass(frozen=True)
class Seat:
    """Where a sensor is at the moment of a reading, in the frame of the map or of the robot: m, rad."""

    x: float
    y: float
    yaw: float

    def on(self, robot: Seat) -> Seat:
        """This seat on a robot that stands there."""
        c, s = math.cos(robot.yaw), math.sin(robot.yaw)
        return Seat(
            robot.x + c * self.x - s * self.y, robot.y + s * self.x + c * self.y, robot.yaw + self.yaw
        )


class RangeLayer:
    """The costmap layer for sonars: each cell holds the chance that it is occupied, and readings change it.

    A reading out of min_range..max_range is passed over; NaN is neither below nor above, so it must not come. One
    at max_range clears its cone when clear_on_max_reading is set, and else marks at its end like any other.
    """

    def __init__(
        self, size_m: float, clear_on_max_reading: bool, phi: float = 1.2, cell_m: float = 0.05
    ) -> None:
        self.cell_m, self.phi = cell_m, phi
        self.clear_on_max_reading = clear_on_max_reading
        self.cells = round(size_m / cell_m)
        self.low_m = -size_m / 2
        self.costs = np.full((self.cells, self.cells), 127, dtype=np.uint8)
        self.passed_over = 0
        ticks = self.low_m + (np.arange(self.cells) + 0.5) * cell_m
        self.xs, self.ys = np.meshgrid(ticks, ticks, indexing="ij")

    def take(self, reading: Any, seat: Seat) -> None:
        """Take one sensor_msgs/Range."""
        assert not math.isnan(reading.range), (
            "NaN passes both comparisons, and what then happens is undefined"
        )
        if reading.range < reading.min_range or reading.range > reading.max_range:
            self.passed_over += 1
            return
        clears = reading.range >= reading.max_range and self.clear_on_max_reading
        box = self._bounds(reading.range, reading.field_of_view / 2, seat)
        tip = self._cell(
            seat.x + reading.range * math.cos(seat.yaw), seat.y + reading.range * math.sin(seat.yaw)
        )
        if tip is not None:
            self.costs[tip] = 233
        dx, dy = self.xs[box] - seat.x, self.ys[box] - seat.y
        away = np.hypot(dx, dy)
        aside = np.abs((np.arctan2(dy, dx) - seat.yaw + math.pi) % math.tau - math.pi)
        seen = (
            np.zeros_like(away)
            if clears
            else self._model(reading.range, away, aside, reading.field_of_view / 2)
        )
        prior = self.costs[box] / _SCALE
        occupied, free = seen * prior, (1 - seen) * (1 - prior)
        with np.errstate(invalid="ignore"):
            chance = np.nan_to_num(occupied / (occupied + free))
        self.costs[box] = (chance * _SCALE).astype(np.uint8)

    def _model(
        self, r: float, away: NDArray[np.float64], aside: NDArray[np.float64], half: float
    ) -> NDArray[np.float64]:
        """The chance that a cell is occupied, of a reading alone: low before it, high at it, even behind it."""
        weight = np.where(aside > half, 0.0, 1 - (aside / half) ** 2) * (
            0.5 - 0.5 * np.tanh(2 * (away - self.phi))
        )
        slack = self.cell_m * r
        rise = 0.5 * weight * ((away - (r - 2 * slack)) / slack) ** 2 + 0.5 * (1 - weight)
        peak = weight * (0.5 - 0.5 * ((r - away) / slack) ** 2) + 0.5
        zones = [away < r - 2 * slack, away < r - slack, away < r + slack]
        return np.select(zones, [0.5 * (1 - weight), rise, peak], 0.5)

    def _cell(self, x: float, y: float) -> tuple[int, int] | None:
        i, j = (int((value - self.low_m) // self.cell_m) for value in (x, y))
        return (i, j) if 0 <= i < self.cells and 0 <= j < self.cells else None

    def _bounds(self, range_m: float, half: float, seat: Seat) -> tuple[slice, slice]:
        """The box round the cone, a fifth longer: with inflate_cone at its default all of it is updated."""
        corners = [(seat.x, seat.y)]
        for turn in (-half, half):
            yaw = seat.yaw + turn
            corners.append((seat.x + math.cos(yaw) * range_m * 1.2, seat.y + math.sin(yaw) * range_m * 1.2))
        found = []
        for values in zip(*corners, strict=True):
            low, high = (int((edge - self.low_m) // self.cell_m) for edge in (min(values), max(values)))
            found.append(slice(max(0, low), min(self.cells, high + 1)))
        return found[0], found[1]

    def grid(self, clear: float = 0.2, mark: float = 0.8) -> NDArray[np.uint8]:
        """What the master costmap gets: free, lethal, or nothing."""
        out = np.full(self.costs.shape, UNKNOWN, dtype=np.uint8)
        out[self.costs < int(clear * _SCALE)] = FREE
        out[self.costs > int(mark * _SCALE)] = LETHAL
        return out


def is_well_formed(reading: Any) -> bool:
    """Whether Nav2 takes a sensor_msgs/Range at all (nav2_ros_common/validate_messages.hpp)."""
    values = (reading.range, reading.min_range, reading.max_range, reading.field_of_view)
    return (
        reading.header.stamp.nanosec < 1_000_000_000
        and reading.header.frame_id != ""
        and all(map(math.isfinite, values))
        and 0 < reading.field_of_view <= _WIDEST_RAD
        and 0 <= reading.min_range < reading.max_range
    )


@dataclass
class Source:
    """A source of the collision monitor: its last message that was not malformed."""

    seat: Seat
    last: Any = None
    points: list[tuple[float, float]] | None = None


@dataclass
class CollisionMonitor:
    """The collision monitor with one stop polygon, a box ahead of the robot.

    A malformed message (see is_well_formed) is rejected, and the one before stays. A source that gives no
    data for source_timeout, or whose range is out of its limits, is invalid, and the robot is stopped for that;
    a timeout of 0 takes that from it.
    """

    box: tuple[float, float, float, float]
    source_timeout: float = 2.0
    min_points: int = 4
    step_rad: float = math.pi / 180
    sources: dict[str, Source] = field(default_factory=dict)

    def add(self, name: str, seat: Seat) -> None:
        """Add a source."""
        self.sources[name] = Source(seat)

    def take_range(self, name: str, reading: Any) -> None:
        """Take a sensor_msgs/Range of a source."""
        if is_well_formed(reading):
            self.sources[name].last = reading

    def take_cloud(self, name: str, cloud: Any, points: Sequence[tuple[float, float]]) -> None:
        """Take a cloud in the robot's frame."""
        self.sources[name].last, self.sources[name].points = cloud, list(points)

    def verdict(self, now_s: float) -> str:
        """What it makes of the present: go, stop, or invalid source NAME, which is a stop as well."""
        seen: list[tuple[float, float]] = []
        for name, source in self.sources.items():
            points = self._points(source, now_s)
            if points is None and self.source_timeout:
                return f"invalid source {name}"
            seen += points or []
        low_x, high_x, low_y, high_y = self.box
        inside = sum(low_x <= x <= high_x and low_y <= y <= high_y for x, y in seen)
        return "stop" if inside >= self.min_points else "go"

    def _points(self, source: Source, now_s: float) -> Iterable[tuple[float, float]] | None:
        last = source.last
        if last is None:
            return None
        at_s = last.header.stamp.sec + last.header.stamp.nanosec / 1e9
        if self.source_timeout and now_s - at_s > self.source_timeout:
            return None
        if source.points is not None:
            return source.points
        if not last.min_range <= last.range <= last.max_range:
            return None
        half = last.field_of_view / 2
        turns = [*np.arange(-half, half, self.step_rad), half]
        seat = source.seat
        return [
            (seat.x + last.range * math.cos(seat.yaw + turn), seat.y + last.range * math.sin(seat.yaw + turn))
            for turn in turns
        ]
