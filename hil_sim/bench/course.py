# SPDX-License-Identifier: MIT
"""Random courses: legs between places of a world that are clear enough, the same again from the same seed."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from hil_sim.errors import SimError
from hil_sim.tables.robot import robot_table
from hil_sim.world.model import World

CELL_MM: Final = 50.0
_BODY: Final = robot_table().body
SWING_MM: Final = _BODY.reach_mm
"""Radius of the circle that the body sweeps when it turns in place."""
ROOM_MM: Final = SWING_MM + 250.0
"""Distance of a waypoint from the nearest solid: 250 mm round the body at every heading."""
LEG_MM: Final = _BODY.half_mm + 250.0
"""Distance of a leg from the nearest solid: 250 mm beside a body that drives along it."""
REACH_MM: Final = 24_000.0
"""No waypoint is further than this from the start along x or y: the firmware takes courses of 30 m to each side."""
WAYPOINTS: Final = 60
_CAP_MM: Final = 1000.0
_LEG_MIN_MM, _LEG_MAX_MM = 1200.0, 9000.0
_CANDIDATES: Final = 400

Floats = npt.NDArray[np.float64]
Point = tuple[float, float]


@dataclass(frozen=True, eq=False)
class Field:
    """Distances of grid cells from the nearest solid, capped, and which cells the robot can get to."""

    x0: float
    y0: float
    distance: Floats
    reachable: npt.NDArray[np.bool_]

    def at(self, x: Floats, y: Floats) -> Floats:
        """Return the distances at places; 0 outside of the grid."""
        column = np.floor((x - self.x0) / CELL_MM).astype(np.int64)
        row = np.floor((y - self.y0) / CELL_MM).astype(np.int64)
        rows, columns = self.distance.shape
        inside = (row >= 0) & (row < rows) & (column >= 0) & (column < columns)
        values = self.distance[np.clip(row, 0, rows - 1), np.clip(column, 0, columns - 1)]
        return np.where(inside, values, 0.0)

    def places(self, clear_mm: float) -> Floats:
        """Return the centres of the reachable cells that are this clear, N x 2."""
        rows, columns = np.nonzero(self.reachable & (self.distance >= clear_mm))
        return np.stack((self.x0 + (columns + 0.5) * CELL_MM, self.y0 + (rows + 0.5) * CELL_MM), axis=1)

    def leg_clear_mm(self, start: Point, ends: Floats) -> Floats:
        """Return the smallest distance from a solid along the straight leg to each of the ends, N."""
        way = np.hypot(ends[:, 0] - start[0], ends[:, 1] - start[1])
        steps = max(2, math.ceil(float(way.max()) / CELL_MM))
        along = np.linspace(0.0, 1.0, steps)
        xs = start[0] + np.outer(ends[:, 0] - start[0], along)
        ys = start[1] + np.outer(ends[:, 1] - start[1], along)
        smallest: Floats = self.at(xs, ys).min(axis=1)
        return smallest


def make_field(world: World) -> Field:
    """Measure a world. Cost: about 0.1 s for a building of 20 by 20 m."""
    low_x, low_y, high_x, high_y = world.bounds
    start = world.start
    low_x, high_x = max(low_x, start.x_mm - REACH_MM), min(high_x, start.x_mm + REACH_MM)
    low_y, high_y = max(low_y, start.y_mm - REACH_MM), min(high_y, start.y_mm + REACH_MM)
    columns = max(1, math.ceil((high_x - low_x) / CELL_MM))
    rows = max(1, math.ceil((high_y - low_y) / CELL_MM))
    xs: Floats = np.arange(columns, dtype=np.float64) * CELL_MM + (low_x + CELL_MM / 2)
    ys: Floats = np.arange(rows, dtype=np.float64) * CELL_MM + (low_y + CELL_MM / 2)
    distance = np.full((rows, columns), _CAP_MM)
    for x1, y1, x2, y2 in [*world.segments.tolist(), *world.forbidden.tolist()]:
        left, right = np.searchsorted(xs, (min(x1, x2) - _CAP_MM, max(x1, x2) + _CAP_MM))
        low, high = np.searchsorted(ys, (min(y1, y2) - _CAP_MM, max(y1, y2) + _CAP_MM))
        if left >= right or low >= high:
            continue
        part = distance[low:high, left:right]
        np.minimum(part, _from_segment(xs[left:right], ys[low:high], x1, y1, x2, y2), out=part)
    return Field(low_x, low_y, distance, _flood(distance >= LEG_MM, start.x_mm - low_x, start.y_mm - low_y))


def _from_segment(xs: Floats, ys: Floats, x1: float, y1: float, x2: float, y2: float) -> Floats:
    ex, ey = x2 - x1, y2 - y1
    wx, wy = xs[None, :] - x1, ys[:, None] - y1
    t = np.clip((wx * ex + wy * ey) / (ex * ex + ey * ey), 0.0, 1.0)
    result: Floats = np.hypot(wx - t * ex, wy - t * ey)
    return result


def _flood(free: npt.NDArray[np.bool_], x: float, y: float) -> npt.NDArray[np.bool_]:
    """The free cells that hang together with the one at x, y."""
    rows, columns = free.shape
    seen = np.zeros_like(free)
    row, column = int(y / CELL_MM), int(x / CELL_MM)
    if not (0 <= row < rows and 0 <= column < columns):
        return seen
    seen[row, column] = True
    queue = deque([(row, column)])
    is_free, done = free.tolist(), seen.tolist()
    while queue:
        row, column = queue.popleft()
        for r, c in ((row + 1, column), (row - 1, column), (row, column + 1), (row, column - 1)):
            if 0 <= r < rows and 0 <= c < columns and is_free[r][c] and not done[r][c]:
                done[r][c] = True
                queue.append((r, c))
    return np.array(done, dtype=np.bool_)


def make_course(world: World, field: Field, length_mm: float, rng: np.random.Generator) -> tuple[Point, ...]:
    """Return waypoints of a random course of at least this length, or of `WAYPOINTS` legs; the last is the goal.

    Of many random places the next one is that furthest from where the robot has been. Legs that are clear on
    the body's whole circle are preferred, so doors are passed, but not sought.
    """
    places = field.places(ROOM_MM)
    if len(places) < 20:
        raise SimError(f"world {world.name}: too little room round its start for a course; choose another")
    here = (world.start.x_mm, world.start.y_mm)
    been = [here]
    course: list[Point] = []
    driven = 0.0
    while driven < length_mm and len(course) < WAYPOINTS:
        picks = places[rng.integers(0, len(places), _CANDIDATES)]
        way = np.hypot(picks[:, 0] - here[0], picks[:, 1] - here[1])
        clear = field.leg_clear_mm(here, picks)
        usable = (way >= _LEG_MIN_MM) & (way <= _LEG_MAX_MM) & (clear >= LEG_MM)
        if not usable.any():
            usable = (way >= 300.0) & (clear >= min(LEG_MM, float(field.at(*_one(here))[0]) - CELL_MM))
        if not usable.any():
            raise SimError(f"world {world.name}: no way on from {here[0]:.0f},{here[1]:.0f}; choose another")
        recent = np.array(been[-12:])
        novelty = np.hypot(
            picks[:, None, 0] - recent[None, :, 0], picks[:, None, 1] - recent[None, :, 1]
        ).min(axis=1)
        score = novelty + rng.uniform(0, 2500, len(picks)) - 1500.0 * (clear < ROOM_MM)
        best = int(np.where(usable, score, -np.inf).argmax())
        driven += float(way[best])
        here = (float(picks[best, 0]), float(picks[best, 1]))
        been.append(here)
        course.append(here)
    return tuple(course)


def _one(point: Point) -> tuple[Floats, Floats]:
    return np.array([point[0]]), np.array([point[1]])
