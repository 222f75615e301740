# SPDX-License-Identifier: MIT
"""Courses that a drifting odometry can drive: no drift puts the way into a wall, and at the goal it cancels out.

A robot without any other means is off by metres after 45 m. What a journey judges is the driver, not its odometry: so
the courses are chosen, with the same drift for all drivers.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from hil_sim.bench.course import LEG_MM, ROOM_MM, WAYPOINTS, Field, Floats, Point
from hil_sim.errors import SimError
from hil_sim.tables.robot import robot_table
from hil_sim.world.model import World

Rng = np.random.Generator
Complex = npt.NDArray[np.complex128]
Course = tuple[Point, ...]

COURSE_MM: Final = 47_000.0
LEAST_MM: Final = 42_000.0
"""A course is some 45 m long, at least 42 where the world is large enough, there and back."""
DRIFT_DEG_M: Final = 0.2
"""Two standard deviations of what every odometry has (0.1 degrees for each metre)."""
ROUGH_DRIFT_DEG_M: Final = 0.6
"""A rough day's 0.5 degrees for each metre, and one standard deviation of that."""
SCALE: Final = 0.01
"""A rough day's part by which distances are off."""
SHORTEST_MM: Final = 8000.0
"""A world that has no way for a course of this length is too small."""
_DRIFTED_MM: Final = robot_table().body.half_mm + 170.0
"""Distance of a leg from the nearest solid where drift puts it: 170 mm beside the body."""
_DRIFTED_END_MM: Final = ROOM_MM - 60.0
"""Distance of a waypoint from the nearest solid where drift puts it: 190 mm round the body."""
_LEG_MM: Final = (1500.0, 9000.0)
_CANDIDATES: Final = 200
_TRIES: Final = 6
_OFF_MM: Final = 60.0
"""A course is good enough when drift has the robot so near to its goal."""
_END_MM: Final = 7000.0
"""The last two legs begin so much before the whole length."""
_END_CANDIDATES: Final = 500
_ENDS: Final = 2500
"""So many pairs of a last waypoint but one and a goal are tried for their clearance."""
_FAR_MM: Final = 1e9


@dataclass
class _Way:
    """A course so far: where odometry has the robot, and where it is by each drift (rad/mm)."""

    drifts: tuple[float, ...]
    here: complex
    true: list[complex]
    driven_mm: float = 0.0

    def after(self, ends: Complex, drift: int) -> Complex:
        """Where the robot is by this drift when its odometry has it at each of the ends."""
        k, leg = self.drifts[drift], ends - self.here
        length = np.abs(leg)
        turned = np.exp(1j * k * (self.driven_mm + length / 2)) * np.sinc(k * length / (2 * math.pi))
        return np.asarray(self.true[drift] + leg * turned)

    def go(self, end: complex) -> None:
        """Drive to a place."""
        at = np.array([end])
        true = [complex(self.after(at, k)[0]) for k in range(len(self.drifts))]
        self.driven_mm += abs(end - self.here)
        self.here, self.true = end, true


def _xy(points: Complex) -> Floats:
    return np.stack((points.real, points.imag), axis=1)


def _usable(field: Field, way: _Way, ends: Complex) -> npt.NDArray[np.bool_]:
    """Which of the ends the robot gets to, by its odometry and by each drift."""
    length = np.abs(ends - way.here)
    good = np.flatnonzero((length >= _LEG_MM[0]) & (length <= _LEG_MM[1]))
    # The first leg begins wherever the world puts the robot.
    least = min(LEG_MM, float(field.at(*_xy(np.array([way.here])).T)[0]) - 1)
    good = good[_clear(field, way.here, ends[good]) >= least]
    for drift, true in enumerate(way.true):
        there = way.after(ends[good], drift)
        fine = _clear(field, true, there) >= min(least, _DRIFTED_MM)
        good = good[fine & (field.at(there.real, there.imag) >= _DRIFTED_END_MM)]
    return np.isin(np.arange(len(ends)), good)


def _clear(field: Field, start: complex, ends: Complex) -> Floats:
    """The smallest distance from a solid along the straight leg to each of the ends."""
    return field.leg_clear_mm((start.real, start.imag), _xy(ends)) if len(ends) else np.zeros(0)


def drift_course(world: World, field: Field, rng: Rng, drift_deg_m: float = DRIFT_DEG_M) -> Course:
    """Return waypoints of a random course of some 45 m, less where drift leaves no way on.

    drift_deg_m: what odometry does not see of a turn, either way. SimError when the world has no course of 8 m.
    Cost: 0.3 s, in a narrow world 2 s.
    """
    spots = field.places(ROOM_MM)
    if len(spots) < 20:
        raise SimError(f"world {world.name}: too little room round its start for a course; choose another")
    places: Complex = spots[:, 0] + 1j * spots[:, 1]
    begin = (world.start.x_mm, world.start.y_mm)
    best: Course = ()
    worth = (0.0, 0.0)
    for _ in range(_TRIES):
        course = _course(field, places, complex(*begin), drift_deg_m, rng)
        off = max(drift_at_goal_mm(begin, course, drift) for drift in (-drift_deg_m, drift_deg_m))
        of = min(LEAST_MM, length_mm(begin, course)), -off
        if of > worth:
            best, worth = course, of
        if worth[0] >= LEAST_MM and off <= _OFF_MM:
            break
    if worth[0] < SHORTEST_MM:
        raise SimError(
            f"world {world.name}: no course of {SHORTEST_MM / 1000:g} m from its start; choose another"
        )
    return best


def _course(field: Field, places: Complex, start: complex, drift_deg_m: float, rng: Rng) -> Course:
    """A random course; nothing when it ends where drift can not be made up for."""
    k = math.radians(drift_deg_m) / 1000
    way = _Way((k, -k, k / 2, -k / 2), start, [start] * 4)
    been, course = [start], list[complex]()
    while way.driven_mm < COURSE_MM - _END_MM and len(course) < WAYPOINTS - 2:
        ends = places[rng.integers(0, len(places), _CANDIDATES)]
        good = _usable(field, way, ends)
        if not good.any():
            break
        score = np.abs(ends[:, None] - np.array(been[-12:])[None, :]).min(axis=1)
        score += rng.uniform(0, 2500, len(ends))
        best = complex(ends[int(np.where(good, score, -_FAR_MM).argmax())])
        way.go(best)
        been.append(best)
        course.append(best)
    last = _ends(field, way, places, start, rng)
    return tuple((point.real, point.imag) for point in course + last) if last else ()


def _ends(field: Field, way: _Way, places: Complex, start: complex, rng: Rng) -> list[complex]:
    """The last two waypoints: where every drift has the robot nearest to where its odometry has it."""
    seconds = places[rng.integers(0, len(places), _END_CANDIDATES)]
    seconds = seconds[_usable(field, way, seconds)]
    goals = places[rng.integers(0, len(places), _END_CANDIDATES)]
    if not len(seconds):
        return []
    leg = goals[None, :] - seconds[:, None]
    length = np.abs(leg)
    driven = way.driven_mm + np.abs(seconds - way.here)[:, None] + length / 2
    off = np.zeros(leg.shape)
    for drift, k in enumerate(way.drifts):
        true = way.after(seconds, drift)[:, None] + leg * np.exp(1j * k * driven) * np.sinc(
            k * length / (2 * math.pi)
        )
        off = np.maximum(off, np.abs(true - goals[None, :]))
    off += SCALE * np.abs(goals - start)[None, :]
    off[(length < _LEG_MM[0]) | (length > _LEG_MM[1])] = _FAR_MM
    for at in np.argsort(off, axis=None)[:_ENDS]:
        i, j = divmod(int(at), len(goals))
        if off[i, j] >= _FAR_MM:
            break
        last = _Way(way.drifts, way.here, list(way.true), way.driven_mm)
        last.go(complex(seconds[i]))
        if _usable(field, last, goals[j : j + 1])[0]:
            return [complex(seconds[i]), complex(goals[j])]
    return []


def length_mm(start: Point, course: Sequence[Point]) -> float:
    """Return the length of a course from its start."""
    return sum(math.dist(a, b) for a, b in zip([start, *course], course, strict=False))


def drift_at_goal_mm(start: Point, course: Course, drift_deg_m: float) -> float:
    """Return how far the robot is from the goal when its odometry has it there, by this drift."""
    begin = complex(*start)
    way = _Way((math.radians(drift_deg_m) / 1000,), begin, [begin])
    for x, y in course:
        way.go(complex(x, y))
    return abs(way.true[0] - way.here)
