# SPDX-License-Identifier: MIT
"""People and doors in motion: where they are at each sub-step, what of them is solid, and when they wait."""

from __future__ import annotations

import ctypes
import itertools
import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from hil_sim.tables.robot import BodyShape, robot_table
from hil_sim.world.body import Segment, body_distance, distance
from hil_sim.world.model import POST_SIDES, Floats, Pose
from hil_sim.world.movers import Door, Mover, Person
from hil_sim.world.state import ACTORS_MAX, DOOR, PERSON, ActorState, LegState, MoversState
from hil_sim.world.step import STEP_MS, STEP_S

AHEAD_MM: Final = 400.0
"""A person waits while the robot's body is within this of their way."""
LEAF_MM: Final = 100.0
"""A door waits while the robot's body is this near to the leaf, or to where the leaf comes next."""
_LEAF_AHEAD_MM: Final = 200.0
_LOOK_STEPS: Final = 5
"""Who waits looks again after so many sub-steps."""
_ROBOT_MM_S: Final = 2000.0
"""No part of the robot is faster."""


class Walker(ActorState):
    """A person."""

    def __init__(self, person: Person, body: BodyShape) -> None:
        super().__init__(_kind=PERSON, _sign=1, _yields=person.yields)
        self._body, self._robot_reach_mm = body, body.reach_mm
        angles = [2 * math.pi * (k + 0.5) / POST_SIDES for k in range(POST_SIDES)]
        # Corners outside the circle, so that the sides touch it: a person is no thinner than the file says.
        outer = person.radius / math.cos(math.pi / POST_SIDES)
        points = [(outer * math.cos(a), outer * math.sin(a)) for a in angles]
        ends = zip(points, points[1:] + points[:1], strict=True)
        self.shape: Floats = np.array([(*a, *b) for a, b in ends])
        self.roughness = person.roughness
        self.reach_mm = outer
        self.fastest_mm_s = person.speed
        self.person = person
        self.c, self.s = 1.0, 0.0
        self._way = [
            (a, b, math.dist(a, b)) for a, b in itertools.pairwise(person.path) if math.dist(a, b) > 0
        ]
        self._rows = (LegState * len(self._way))(*(LegState(*a, *b, length) for a, b, length in self._way))
        self._legs, self._legs_count = ctypes.addressof(self._rows), len(self._way)
        self._speed, self._radius = person.speed, person.radius
        self._step_mm = person.speed * STEP_S
        self._patience_ms = person.patience * 1000
        self._pause_ms = person.pause * 1000 if person.loop else math.inf
        self._rest_ms = person.delay * 1000
        self.x, self.y = self._way[0][0]

    def step(self, robot: Pose) -> bool:
        """Walk on, unless it is time to stand or the robot is in the way."""
        if self._rest_ms > 0:
            self._rest_ms -= STEP_MS
            self._unwatched -= 1
            return False
        self._unwatched -= 1
        if self._held > 0 or (self._unwatched <= 0 and self.person.yields and self._is_blocked(robot)):
            self._wait()
            return False
        self._waited_ms = 0.0
        self._walk()
        return True

    def _wait(self) -> None:
        self._held = (self._held or _LOOK_STEPS) - 1
        self._waited_ms += STEP_MS
        if 0 < self._patience_ms <= self._waited_ms:
            self._waited_ms = 0.0
            self._sign = -self._sign
            self._unwatched = 0

    def _walk(self) -> None:
        (x1, y1), (x2, y2), length = self._way[self._leg]
        self._along += self._sign * self._step_mm
        if not 0 <= self._along <= length:
            over = self._along - length if self._sign > 0 else -self._along
            self._turn_corner(over)
            (x1, y1), (x2, y2), length = self._way[self._leg]
        part = self._along / length
        self.x, self.y = x1 + (x2 - x1) * part, y1 + (y2 - y1) * part

    def _turn_corner(self, over: float) -> None:
        """Go on with the next leg, or stand at the end of the way; `over` is what the step has left."""
        self._unwatched = 0
        ahead = self._leg + self._sign
        while 0 <= ahead < len(self._way):
            self._leg, length = ahead, self._way[ahead][2]
            self._along = over if self._sign > 0 else length - over
            if 0 <= self._along <= length:
                return
            over, ahead = over - length, ahead + self._sign
        self._along = self._way[self._leg][2] if self._sign > 0 else 0.0
        self._sign = -self._sign
        self._rest_ms = self._pause_ms

    def _is_blocked(self, robot: Pose) -> bool:
        """Whether the body is in the strip ahead, as wide as the person."""
        away = distance(robot.x_mm - self.x, robot.y_mm - self.y)
        spare = away - self._robot_reach_mm - AHEAD_MM - self.person.radius
        if spare > 0:
            self._unwatched = self._steps_until(spare)
            return False
        (x1, y1), (x2, y2), length = self._way[self._leg]
        part = self._sign * AHEAD_MM / length
        ahead = self.x, self.y, self.x + (x2 - x1) * part, self.y + (y2 - y1) * part
        gap = body_distance(robot, ahead, self._body) - self.person.radius
        self._unwatched = self._steps_until(gap)
        return gap <= 0

    def _steps_until(self, gap_mm: float) -> int:
        """Return sub-steps in which such a gap cannot close: the next look can wait."""
        return int(gap_mm / ((_ROBOT_MM_S + self.person.speed) * STEP_S))


class _Leaf(ActorState):
    """A door."""

    def __init__(self, door: Door, body: BodyShape) -> None:
        super().__init__(_kind=DOOR, _yields=door.yields)
        self._body, self._robot_reach_mm = body, body.reach_mm
        self.shape: Floats = np.array([(0.0, 0.0, door.width, 0.0)])
        self.roughness = door.roughness
        self.reach_mm = door.width
        self.door = door
        self.x, self.y = door.hinge
        self._width, self._closed, self._open = door.width, door.closed, door.open
        self._delay_ms = door.delay * 1000
        self._period_ms, self._swing_ms = door.period * 1000, door.swing * 1000
        self._still_ms = door.period * 500 - door.swing * 1000
        self.fastest_mm_s = math.radians(abs(door.open - door.closed)) * door.width / door.swing
        self._ahead_ms = _LEAF_AHEAD_MM / self.fastest_mm_s * 1000
        self.c, self.s = self._direction(0.0)

    def _direction(self, t_ms: float) -> tuple[float, float]:
        """Where the leaf points `t_ms` after an opening began."""
        door, swing_ms = self.door, self._swing_ms
        t_ms %= self._period_ms
        closing_ms = t_ms - swing_ms - self._still_ms
        part = min(t_ms / swing_ms, 1.0) if closing_ms < 0 else max(0.0, 1.0 - closing_ms / swing_ms)
        angle = math.radians(door.closed + (door.open - door.closed) * part)
        return math.cos(angle), math.sin(angle)

    def step(self, robot: Pose) -> bool:
        """Swing on, unless it is time to rest or the robot is in the way."""
        if self._delay_ms > 0:
            self._delay_ms -= STEP_MS
            return False
        if self._is_resting():
            self._t_ms += STEP_MS
            return False
        then = self._direction(self._t_ms + STEP_MS)
        if then == (self.c, self.s):
            self._t_ms += STEP_MS
            return False
        if self.door.yields and self._is_blocked(robot):
            return False
        self._t_ms += STEP_MS
        self.c, self.s = then
        return True

    def _is_resting(self) -> bool:
        """Neither this sub-step nor the next moves the leaf."""
        t_ms, swing_ms = self._t_ms % self._period_ms, self._swing_ms
        shut_ms = swing_ms + self._still_ms + swing_ms
        return swing_ms <= t_ms <= swing_ms + self._still_ms - STEP_MS or shut_ms <= t_ms

    def _is_blocked(self, robot: Pose) -> bool:
        away = distance(robot.x_mm - self.x, robot.y_mm - self.y)
        if away > self._robot_reach_mm + self.door.width + LEAF_MM:
            return False
        ahead = self._direction(self._t_ms + self._ahead_ms)
        return any(
            body_distance(
                robot,
                (self.x, self.y, self.x + c * self.door.width, self.y + s * self.door.width),
                self._body,
            )
            <= LEAF_MM
            for c, s in ((self.c, self.s), ahead)
        )


class MovingSolids(MoversState):
    """All that moves by itself in one run; `moment` counts the sub-steps in which anything did."""

    def __init__(self, movers: Sequence[Mover], body: BodyShape | None = None) -> None:
        """`body`: of the robot for which they wait; None is the one that is emulated by default."""
        super().__init__()
        body = body if body is not None else robot_table().body
        self.actors: list[Walker | _Leaf] = [
            Walker(mover, body) if isinstance(mover, Person) else _Leaf(mover, body) for mover in movers
        ]
        self._keep(self.actors, body)
        self.shape: Floats = np.concatenate([actor.shape for actor in self.actors])
        counts = [len(actor.shape) for actor in self.actors]
        self.owner = np.repeat(np.arange(len(counts), dtype=np.int32), counts)
        self.roughness: Floats = np.repeat([actor.roughness for actor in self.actors], counts)
        self.fastest_mm_s = max(actor.fastest_mm_s for actor in self.actors)
        self._sides = [[tuple(row) for row in actor.shape.tolist()] for actor in self.actors]
        self.places: Floats = np.zeros((len(self.actors), 4))
        """For each actor x, y, cosine and sine of its axes, as `place` left them."""
        self._flat = memoryview(self.places.data).cast("B").cast("d")

    @property
    def fits_c(self) -> bool:
        """C can let them move."""
        return len(self.actors) <= ACTORS_MAX

    def step(self, robot: Pose) -> None:
        """Let a sub-step pass."""
        moved = False
        for actor in self.actors:
            moved |= actor.step(robot)
        self.moment += moved

    def place(self) -> None:
        """Bring `places` up to date."""
        flat, at = self._flat, 0
        for actor in self.actors:
            flat[at], flat[at + 1], flat[at + 2], flat[at + 3] = actor.x, actor.y, actor.c, actor.s
            at += 4

    def near(self, pose: Pose, within_mm: float) -> list[Segment]:
        """The segments of the actors that may be so near to the centre of the body."""
        found: list[Segment] = []
        for actor, rows in zip(self.actors, self._sides, strict=True):
            x, y, c, s = actor.x, actor.y, actor.c, actor.s
            if math.hypot(x - pose.x_mm, y - pose.y_mm) <= within_mm + actor.reach_mm:
                found += [
                    (x + a * c - b * s, y + a * s + b * c, x + d * c - e * s, y + d * s + e * c)
                    for a, b, d, e in rows
                ]
        return found


def moving_solids(movers: Sequence[Mover], body: BodyShape | None = None) -> MovingSolids | None:
    """Return what these movers are in a run; None without any. `body`: as for MovingSolids."""
    return MovingSolids(movers, body) if movers else None
