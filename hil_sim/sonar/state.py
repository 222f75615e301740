# SPDX-License-Identifier: MIT
"""The ring's schedule and its readings under way, laid out so that tick.c works on the same memory as the Python."""

from __future__ import annotations

import ctypes
import math
import struct
from collections.abc import Sequence
from typing import Final

from hil_sim.arcos import TIMING
from hil_sim.sonar.params import Reading

ARRAYS: Final = TIMING["ARRAYS_MAX"]
MAX_ORDER: Final = TIMING["POLLING_MAX_PER_ARRAY"]
_KEPT: Final = 128
_ROW: Final = struct.Struct("=diiii")


class OthersState(ctypes.Structure):
    """What is heard of people and doors as they were at a moment, and the arrays that tell it."""

    _moment: int
    _here: int | None
    _forms: int | None
    _owners: int | None
    _corner_owners: int | None
    _places: int | None
    _fields_ = [
        ("_moment", ctypes.c_int64),
        *((name, ctypes.c_void_p) for name in ("_here", "_forms", "_owners", "_corner_owners", "_places")),
    ]


class ArrayState(ctypes.Structure):
    """The firing state of one array; next_ms: NaN until it is known."""

    next_ms: float
    last_ms: float
    last_number: int
    place: int
    count: int
    numbers: ctypes.Array[ctypes.c_int32]
    _fields_ = [
        ("next_ms", ctypes.c_double),
        ("last_ms", ctypes.c_double),
        *((name, ctypes.c_int32) for name in ("last_number", "place", "count")),
        ("numbers", ctypes.c_int32 * MAX_ORDER),
    ]

    def begin(self, order: Sequence[int]) -> None:
        """Stand at the start of a firing order, nothing fired yet."""
        self.next_ms, self.last_ms, self.last_number = math.nan, -math.inf, -1
        self.order = list(order)

    @property
    def order(self) -> list[int]:
        """The sonars in the order in which they fire; one that is set begins at its start."""
        return list(self.numbers[: self.count])

    @order.setter
    def order(self, order: list[int]) -> None:
        self.numbers[: len(order)] = [*order]
        self.count, self.place = len(order), 0

    @property
    def due(self) -> int:
        """The sonar that fires next."""
        return self.numbers[self.place]


class Rows(ctypes.Structure):
    """Readings as C keeps them."""

    count: int
    _fields_ = [("count", ctypes.c_int64), ("rows", ctypes.c_uint8 * (_ROW.size * _KEPT))]

    def take(self, kinds: Sequence[str | None]) -> list[Reading]:
        """Return them and keep none; kinds: of faults, by their number."""
        data = memoryview(self).cast("B")[8 : 8 + _ROW.size * self.count]
        self.count = 0
        return [
            Reading(t_ms, number, range_mm, true_mm, kinds[kind])
            for t_ms, number, range_mm, true_mm, kind in _ROW.iter_unpack(data)
        ]

    def put(self, readings: Sequence[Reading], kinds: list[str | None]) -> None:
        """Keep these behind those that are kept."""
        data = memoryview(self).cast("B")
        for reading in readings:
            if reading.fault not in kinds:
                kinds.append(reading.fault)
            _ROW.pack_into(data, 8 + _ROW.size * self.count, *reading[:4], kinds.index(reading.fault))
            self.count += 1


class RingState(ctypes.Structure):
    """Schedule of all arrays; live: those that fire."""

    cycle_ms: int
    _fire_ms: float
    _ready_ms: float
    _last_ms: float
    _quiet: bool
    _lives: int
    _live_at: ctypes.Array[ctypes.c_int32]
    _states: ctypes.Array[ArrayState]
    _under_way: Rows
    _in: Rows
    _fields_ = [
        ("cycle_ms", ctypes.c_int64),
        *((name, ctypes.c_double) for name in ("_fire_ms", "_ready_ms", "_last_ms")),
        ("_states", ArrayState * ARRAYS),
        ("_live_at", ctypes.c_int32 * ARRAYS),
        ("_lives", ctypes.c_int32),
        ("_quiet", ctypes.c_bool),
        ("_under_way", Rows),
        ("_in", Rows),
    ]
