# SPDX-License-Identifier: MIT
"""People and doors from one sub-step to the next, laid out so that moving.c works on the same memory as the Python."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from typing import Final

from hil_sim.tables.robot import BodyShape

PERSON: Final = 0
DOOR: Final = 1
ACTORS_MAX: Final = 32
"""So many C lets move; in a world of more Python does."""
_D, _I, _L, _B = ctypes.c_double, ctypes.c_int32, ctypes.c_int64, ctypes.c_bool


class LegState(ctypes.Structure):
    """A straight part of a person's way: from where to where, and how far."""

    _fields_ = [(name, _D) for name in ("x1", "y1", "x2", "y2", "length")]


class ActorState(ctypes.Structure):
    """Where an actor is, what it does next, and what of its file a sub-step asks for."""

    x: float
    y: float
    c: float
    s: float
    _along: float
    _rest_ms: float
    _waited_ms: float
    _delay_ms: float
    _t_ms: float
    _leg: int
    _sign: int
    _unwatched: int
    _held: int
    _step_mm: float
    _speed: float
    _radius: float
    _patience_ms: float
    _pause_ms: float
    _width: float
    _closed: float
    _open: float
    _period_ms: float
    _swing_ms: float
    _still_ms: float
    _ahead_ms: float
    _legs: int | None
    _legs_count: int
    _kind: int
    _yields: bool
    _fields_ = [
        *(
            (name, _D)
            for name in ("x", "y", "c", "s", "_along", "_rest_ms", "_waited_ms", "_delay_ms", "_t_ms")
        ),
        *((name, _I) for name in ("_leg", "_sign", "_unwatched", "_held")),
        *((name, _D) for name in ("_step_mm", "_speed", "_radius", "_patience_ms", "_pause_ms")),
        *((name, _D) for name in ("_width", "_closed", "_open", "_period_ms", "_swing_ms", "_still_ms")),
        ("_ahead_ms", _D),
        ("_legs", ctypes.c_void_p),
        *((name, _I) for name in ("_legs_count", "_kind")),
        ("_yields", _B),
    ]


class BodyState(ctypes.Structure):
    """The body as a rectangle, and how far its furthest corner is from the centre of rotation."""

    _fields_ = [(name, _D) for name in ("front_mm", "rear_mm", "half_mm", "reach_mm")]


def body_state(shape: BodyShape) -> BodyState:
    """Return a robot's body as C wants it."""
    return BodyState(shape.front_mm, shape.rear_mm, shape.half_mm, shape.reach_mm)


class MoversState(ctypes.Structure):
    """All actors, the body for which they wait, and how often any of them has moved."""

    moment: int
    _fields_ = [
        ("moment", _L),
        ("_body", BodyState),
        ("_actors", ctypes.c_void_p),
        ("_count", _I),
    ]

    def _keep(self, actors: Sequence[ActorState], body: BodyShape) -> None:
        """Note the actors, which stay where they are in memory."""
        self._addresses = (ctypes.c_void_p * len(actors))(*map(ctypes.addressof, actors))
        self._actors, self._count = ctypes.addressof(self._addresses), len(actors)
        self._body = body_state(body)
