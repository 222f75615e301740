# SPDX-License-Identifier: MIT
"""What SIPs say, and the truth, in columns: sightings.c writes the same memory."""

from __future__ import annotations

import ctypes
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from hil_sim import native
from hil_sim.robot.interfaces import SonarReading
from hil_sim.robot.robot import Robot
from hil_sim.sonar.params import Reading
from hil_sim.world.model import Pose

_ROWS: Final = 512
_READINGS: Final = 8192
_ON_THE_LINE: Final = 64
_FRAME: Final = 260
_MADE: Final = struct.Struct("=ddddqi")
_TAKEN: Final = struct.Struct("=idddddd")
_HEARD: Final = struct.Struct("=diiii")
ROW: Final = np.dtype(
    [
        *((name, "<f8") for name in ("t_ms", "x", "y", "heading")),
        ("first", "<i8"),
        ("count", "<i4"),
        ("mode", "<i4"),
        *((name, "<f8") for name in ("true_x", "true_y", "th", "travelled_mm", "v", "w")),
    ]
)
"""One SIP.

t_ms, x, y, heading: when it was made (ms), and where the robot was then (mm, degrees in (-180, 180]). first, count: its
readings among all. The rest is of the moment at which the fault manager has taken it: mode, by its number; where the
robot is (mm, degrees without bounds), how far it has driven (mm), its speeds (mm/s, degrees a second).
"""
READING: Final = np.dtype(
    [("t_ms", "<f8"), *((name, "<i4") for name in ("number", "range_mm", "true_mm", "kind"))]
)
"""One reading: when it was completed (ms), of which sonar, what is reported, what would be without noise, crosstalk and
fault (mm), and the kind of its fault by its number, 0 of none."""
Table = npt.NDArray[np.void]


@dataclass(frozen=True)
class Sighting:
    """What a SIP says, and the truth: the reading as reported, what no fault, noise and crosstalk would give."""

    t_s: float
    pose: Pose
    readings: tuple[SonarReading, ...]


class Seen(NamedTuple):
    """What was seen. rows: of the type ROW. readings: of the type READING. kinds: of faults, by their number."""

    rows: Table
    readings: Table
    kinds: tuple[str | None, ...]

    def listed(self) -> tuple[npt.NDArray[np.intp], Table]:
        """Return the readings that the rows list, in their order, and of each the place of its row."""
        counts = self.rows["count"]
        row = np.repeat(np.arange(len(self.rows)), counts)
        return row, self.readings[
            np.arange(len(row)) + (self.rows["first"] - np.cumsum(counts) + counts)[row]
        ]


class _Sent(ctypes.Structure):
    _fields_ = [
        ("row", ctypes.c_uint8 * ROW.itemsize),
        ("length", ctypes.c_int32),
        ("packet", ctypes.c_uint8 * _FRAME),
    ]


class _Memory(ctypes.Structure):
    rows_count: int
    readings_count: int
    base: int
    first: int
    count: int
    _fields_ = [
        *((name, ctypes.c_int64) for name in ("rows_count", "readings_count", "base", "first", "count")),
        ("rows", ctypes.c_uint8 * (ROW.itemsize * _ROWS)),
        ("readings", ctypes.c_uint8 * (READING.itemsize * _READINGS)),
        ("sent", _Sent * _ON_THE_LINE),
    ]


class Sightings:
    """The SIPs that the fault manager has taken in a mission, with the truth.

    Pass it to `Sil` or `run`, and ask it for what was seen when the mission is over. A SIP costs 1 us, and 100 bytes
    and 24 for each reading.
    """

    def __init__(self, *, keep: bool = True) -> None:
        """`keep`: False: only the last SIP is asked for."""
        self._memory = _Memory()
        self._keep = keep
        self._old_rows: list[Table] = []
        self._old_readings: list[Table] = []
        self._kinds: list[str | None] = [None]
        self.address = ctypes.addressof(self._memory)
        found = native.library()
        if found is not None and found.argus_sim_sightings_size() != ctypes.sizeof(_Memory):
            raise AssertionError(
                f"sightings.c has {found.argus_sim_sightings_size()} bytes, sightings.py {ctypes.sizeof(_Memory)}"
            )

    @property
    def seen(self) -> Seen:
        """What was seen so far."""
        rows = np.concatenate([*self._old_rows, self._rows()])
        return Seen(rows, np.concatenate([*self._old_readings, self._readings()]), tuple(self._kinds))

    def _rows(self) -> Table:
        return np.frombuffer(self._memory.rows, ROW, self._memory.rows_count)

    def _readings(self) -> Table:
        return np.frombuffer(self._memory.readings, READING, self._memory.readings_count)

    @property
    def count(self) -> int:
        """Rows that were not moved out of the memory that C writes."""
        return self._memory.rows_count

    @property
    def last(self) -> Sighting:
        """The SIP that was taken last."""
        memory = self._memory
        data = memoryview(memory.rows)[ROW.itemsize * (memory.rows_count - 1) :]
        t_ms, x, y, heading, first, count = _MADE.unpack_from(data)
        size = READING.itemsize
        begin = first - memory.base
        heard = memoryview(memory.readings)[size * begin : size * (begin + count)]
        kinds = self._kinds
        readings = tuple(
            Reading(t_ms, number, range_mm, true_mm, kinds[kind])
            for t_ms, number, range_mm, true_mm, kind in _HEARD.iter_unpack(heard)
        )
        return Sighting(t_ms / 1000, Pose(x, y, heading), readings)

    def begin(self, kinds: list[str | None]) -> None:
        """Take the kinds of faults, by their number, from where they are kept; it may grow."""
        self._kinds = kinds

    def make_room(self) -> None:
        """Move what was taken out of the memory that C writes; what is on the line stays."""
        memory = self._memory
        if memory.rows_count <= _ROWS // 2 and memory.readings_count <= _READINGS // 2:
            return
        rows, readings = self._rows().copy(), self._readings().copy()
        left = memory.readings_count
        if memory.count:
            first: int = _MADE.unpack_from(memory.sent[memory.first].row)[4]
            left = first - memory.base
        if self._keep:
            self._old_rows.append(rows)
            self._old_readings.append(readings[:left])
        rest = readings[left:]
        ctypes.memmove(memory.readings, rest.ctypes.data, rest.nbytes)
        memory.base += left
        memory.readings_count -= left
        memory.rows_count = 0

    def sent(self, packet: bytes, robot: Robot, readings: Sequence[SonarReading]) -> None:
        """A SIP goes on the line."""
        self.make_room()
        memory = self._memory
        if memory.count == _ON_THE_LINE:
            self._forget(1)
        sent = memory.sent[(memory.first + memory.count) % _ON_THE_LINE]
        memory.count += 1
        first = memory.base + memory.readings_count
        _MADE.pack_into(sent.row, 0, robot.now_ms, *robot.pose, first, len(readings))
        sent.length = len(packet)
        ctypes.memmove(sent.packet, packet, len(packet))
        for reading in readings:
            kind = self._kind_of(reading.fault)
            at = READING.itemsize * memory.readings_count
            values = reading.t_ms, reading.number, reading.range_mm, reading.true_mm, kind
            _HEARD.pack_into(memory.readings, at, *values)
            memory.readings_count += 1

    def _kind_of(self, fault: str | None) -> int:
        if fault not in self._kinds:
            self._kinds.append(fault)
        return self._kinds.index(fault)

    def _forget(self, count: int) -> None:
        self._memory.first = (self._memory.first + count) % _ON_THE_LINE
        self._memory.count -= count

    def taken(self, data: bytes, robot: Robot, mode: int) -> bool:
        """The fault manager has taken a packet; return whether it was a SIP, which is the last one then."""
        memory = self._memory
        for k in range(memory.count):
            sent = memory.sent[(memory.first + k) % _ON_THE_LINE]
            if sent.length == len(data) and ctypes.string_at(sent.packet, sent.length) == data:
                at = ROW.itemsize * memory.rows_count
                ctypes.memmove(ctypes.byref(memory.rows, at), sent.row, ROW.itemsize)
                chassis, drive = robot.chassis, robot.drive
                places = chassis.x, chassis.y, chassis.th, chassis.travelled_mm
                _TAKEN.pack_into(memory.rows, at + _MADE.size, mode, *places, drive.v, drive.w)
                memory.rows_count += 1
                self._forget(k + 1)
                return True
        return False
