# SPDX-License-Identifier: MIT
"""The robot's body as a rectangle among solids: where it touches them, and how far away they are."""

from __future__ import annotations

import ctypes
import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Final, Protocol, TypeAlias

import numpy as np

from hil_sim.native import library
from hil_sim.tables.robot import BodyShape, robot_table
from hil_sim.world.model import Floats, Pose, World
from hil_sim.world.state import body_state

_SEGMENTS: Final = 5
"""Strips of each end that a contact is told by: as many as a bumper has segments, whether there is one or not."""
_BUMPER_DEPTH_MM: Final = 60.0
"""How far back along the sides the front and rear bumpers reach: a contact further from the end presses none."""
_CELL_MM: Final = 500.0
_SEARCH_MM: Final = 3000.0
"""Clearances beyond this are reported as this: none is needed, and it bounds the search."""

Segment: TypeAlias = tuple[float, float, float, float]
"""x1, y1, x2, y2 in mm."""


@dataclass(frozen=True)
class Contact:
    """Where the body meets a solid.

    front: ahead of the centre of rotation. front_segments, rear_segments: bumper segments pressed, bit 1 the
    leftmost to bit 5 the rightmost as seen from the driver's seat.
    """

    front: bool
    front_segments: int
    rear_segments: int


class Moving(Protocol):
    """What the body asks of solids that move by themselves."""

    def near(self, pose: Pose, within_mm: float) -> list[Segment]:
        """Return at least the segments within a distance of the centre, as they are now."""


class BodyModel:
    """The body's contact with the solids of one world, and with what moves in it."""

    def __init__(self, world: World, moving: Moving | None = None, shape: BodyShape | None = None) -> None:
        """`shape`: of the robot; None is the one that is emulated by default."""
        self._moving = moving
        self.shape = shape if shape is not None else robot_table().body
        self._reach_mm = self.shape.reach_mm
        self._solids = world.segments
        self._cells: dict[tuple[int, int], _Solids] = {}
        self._measure = _measure_in_c(self.shape) or _measure_in_python(self.shape)
        self._last: tuple[float, float, float] | None = None
        self._last_clearance = 0.0

    def contact(self, pose: Pose, now_ms: float) -> Contact | None:  # noqa: ARG002 - for solids that move
        """Return the contact at `pose`, or None when the body is free. Cost: 1 us while it cannot have arrived."""
        pieces = self._still_pieces(pose)
        if self._moving is not None:
            pieces += self._pieces(pose, self._moving.near(pose, self._reach_mm))
        if not pieces:
            return None
        front_x = max(max(piece[0], piece[2]) for piece in pieces)
        front = sum(
            1 << k for k in _pressed(pieces, 1.0, self.shape.front_mm - _BUMPER_DEPTH_MM, self.shape.half_mm)
        )
        rear = sum(
            1 << k for k in _pressed(pieces, -1.0, self.shape.rear_mm - _BUMPER_DEPTH_MM, self.shape.half_mm)
        )
        return Contact(front_x > 0 if not front and not rear else front != 0, front, rear)

    def _still_pieces(self, pose: Pose) -> list[Segment]:
        if self._last is not None and self._travel(pose, self._last) < self._last_clearance:
            return []
        pieces = self._pieces(pose, self._near(pose).segments)
        if not pieces:
            self._remember(pose, self._measure(pose, self._near(pose)))
        return pieces

    def _pieces(self, pose: Pose, segments: list[Segment]) -> list[Segment]:
        """What of the segments is inside the body, in its frame."""
        clipped = (_clip(self.shape, *_to_body(pose, segment)) for segment in segments)
        return [piece for piece in clipped if piece is not None]

    def clearance_mm(self, pose: Pose) -> float:
        """Return the distance from the body to the nearest solid, 0 when they meet, at most 3000."""
        key = (pose.x_mm, pose.y_mm, pose.heading_deg)
        if key != self._last:
            self._remember(pose, self._measure(pose, self._near(pose)))
        if self._moving is None:
            return self._last_clearance
        reach = self._last_clearance + self._reach_mm
        return min(self._last_clearance, self._measure(pose, _Solids(self._moving.near(pose, reach))))

    def _remember(self, pose: Pose, clearance: float) -> None:
        self._last = (pose.x_mm, pose.y_mm, pose.heading_deg)
        self._last_clearance = clearance

    def _travel(self, pose: Pose, last: tuple[float, float, float]) -> float:
        """The most that any point of the body can have moved since `last`."""
        turn = abs((pose.heading_deg - last[2] + 180) % 360 - 180)
        return math.hypot(pose.x_mm - last[0], pose.y_mm - last[1]) + math.radians(turn) * self._reach_mm

    def _near(self, pose: Pose) -> _Solids:
        """Solids within the search distance of the pose's grid cell."""
        cell = (math.floor(pose.x_mm / _CELL_MM), math.floor(pose.y_mm / _CELL_MM))
        if cell not in self._cells:
            x, y = (cell[0] + 0.5) * _CELL_MM, (cell[1] + 0.5) * _CELL_MM
            limit = _SEARCH_MM + self._reach_mm + _CELL_MM
            near = self._solids[distances_mm(self._solids, x, y) <= limit]
            self._cells[cell] = _Solids([(a, b, c, d) for a, b, c, d in near.tolist()])
        return self._cells[cell]


class _Solids:
    """Segments, and the same as C wants them."""

    def __init__(self, segments: list[Segment]) -> None:
        self.segments = segments

    @cached_property
    def for_c(self) -> ctypes.Array[ctypes.c_double]:
        return (ctypes.c_double * (4 * len(self.segments)))(*itertools.chain.from_iterable(self.segments))


_Measure: TypeAlias = Callable[[Pose, _Solids], float]
"""Returns the distance from the body to the nearest solid, at most `_SEARCH_MM`."""


def _measure_in_c(shape: BodyShape) -> _Measure | None:
    found = library()
    if found is None:
        return None
    body, clearance = body_state(shape), found.argus_sim_clearance

    def measure(pose: Pose, solids: _Solids) -> float:
        at = pose.x_mm, pose.y_mm, pose.heading_deg
        nearest: float = clearance(ctypes.byref(body), *at, solids.for_c, len(solids.segments), _SEARCH_MM)
        return nearest

    return measure


def _measure_in_python(shape: BodyShape) -> _Measure:
    def measure(pose: Pose, solids: _Solids) -> float:
        best = _SEARCH_MM
        for segment in solids.segments:
            # The rectangle lies within the reach of the centre: most solids are too far to improve on `best`.
            if _point_distance(pose.x_mm, pose.y_mm, *segment) - shape.reach_mm < best:
                best = min(best, body_distance(pose, segment, shape))
        return best

    return measure


def distance(dx: float, dy: float) -> float:
    """Return the length of a difference: as moving.c forms it, to the last bit."""
    return math.sqrt(dx * dx + dy * dy)


def body_distance(pose: Pose, segment: Segment, shape: BodyShape) -> float:
    """Return the distance from the body at `pose` to a segment, 0 when they meet."""
    return _rectangle_distance(shape, *_to_body(pose, segment))


def _to_body(pose: Pose, segment: Segment) -> Segment:
    heading = math.radians(pose.heading_deg)
    c, s = math.cos(heading), math.sin(heading)
    x1, y1 = segment[0] - pose.x_mm, segment[1] - pose.y_mm
    x2, y2 = segment[2] - pose.x_mm, segment[3] - pose.y_mm
    return x1 * c + y1 * s, y1 * c - x1 * s, x2 * c + y2 * s, y2 * c - x2 * s


def _clip(shape: BodyShape, x1: float, y1: float, x2: float, y2: float) -> Segment | None:
    """The part of a segment, in the body's frame, that lies inside the body (Liang and Barsky's method)."""
    dx, dy = x2 - x1, y2 - y1
    low, high = 0.0, 1.0
    ends = (-dx, x1 + shape.rear_mm), (dx, shape.front_mm - x1)
    for step, room in (*ends, (-dy, y1 + shape.half_mm), (dy, shape.half_mm - y1)):
        if step == 0:
            if room < 0:
                return None
        elif step < 0:
            low = max(low, room / step)
        else:
            high = min(high, room / step)
    if low > high:
        return None
    return x1 + low * dx, y1 + low * dy, x1 + high * dx, y1 + high * dy


def _pressed(pieces: list[Segment], side: float, limit: float, half: float) -> set[int]:
    """Bumper segments, 1 leftmost, that the pieces reach at the front (side 1) or the rear (side -1)."""
    pressed: set[int] = set()
    for x1, y1, x2, y2 in pieces:
        a, b = side * x1 - limit, side * x2 - limit
        if a < 0 and b < 0:
            continue
        if a < 0:
            y1 += (y2 - y1) * a / (a - b)
        elif b < 0:
            y2 += (y1 - y2) * b / (b - a)
        pressed.update(range(_strip(max(y1, y2), half), _strip(min(y1, y2), half) + 1))
    return pressed


def _strip(y: float, half: float) -> int:
    return min(_SEGMENTS, max(1, 1 + int((half - y) / (2 * half) * _SEGMENTS)))


def _point_distance(px: float, py: float, x1: float, y1: float, x2: float, y2: float) -> float:
    dx, dy = x2 - x1, y2 - y1
    length = dx * dx + dy * dy
    t = ((px - x1) * dx + (py - y1) * dy) / length if length > 0 else 0.0
    t = min(1.0, max(0.0, t))
    return distance(x1 + t * dx - px, y1 + t * dy - py)


def distances_mm(segments: Floats, x_mm: float, y_mm: float) -> Floats:
    """Return how far a place is from each segment; segments: x1, y1, x2, y2 in mm, (n, 4)."""
    x1, y1, x2, y2 = segments.T
    dx, dy = x2 - x1, y2 - y1
    length = dx * dx + dy * dy
    along = ((x_mm - x1) * dx + (y_mm - y1) * dy) / np.where(length > 0, length, 1.0)
    along = np.clip(along, 0.0, 1.0)
    return np.asarray(np.hypot(x1 + along * dx - x_mm, y1 + along * dy - y_mm))


def _rectangle_distance(shape: BodyShape, x1: float, y1: float, x2: float, y2: float) -> float:
    if _clip(shape, x1, y1, x2, y2) is not None:
        return 0.0
    ends = min(_outside(shape, x1, y1), _outside(shape, x2, y2))
    return min(ends, *(_point_distance(x, y, x1, y1, x2, y2) for x, y in shape.corners))


def _outside(shape: BodyShape, x: float, y: float) -> float:
    return distance(max(x - shape.front_mm, -shape.rear_mm - x, 0.0), max(abs(y) - shape.half_mm, 0.0))
