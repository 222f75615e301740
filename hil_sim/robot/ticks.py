# SPDX-License-Identifier: MIT
"""Sub-steps in C (tick.c) for what is plain; every other one is the Python's, on the same memory."""

from __future__ import annotations

import ctypes
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from hil_sim import native
from hil_sim.arcos import BUMPSTALL, SIP, TIMING
from hil_sim.faults.execute import FaultSet
from hil_sim.robot.chassis import Chassis
from hil_sim.robot.drive import Drive
from hil_sim.robot.energy import ACCEL_FACTOR, INERTIA_KG_M2, MASS_KG, Energy
from hil_sim.robot.interfaces import Faults, Moving, Ring, SonarReading
from hil_sim.robot.stall import StallMonitor
from hil_sim.robot.state import RobotState
from hil_sim.sonar.params import MIN_MM, NO_ECHO_MM, Reading
from hil_sim.sonar.ring import RESUME_MS, SonarRing
from hil_sim.tables.robot import RobotTable
from hil_sim.world.step import STEP_S

_WAITS: Final = 32
_VARIABLES: Final = ("t", "x", "y", "travelled")
_ALL: Final = (1 << 64) - 1
_LEARN: Final = ctypes.CFUNCTYPE(None, ctypes.c_double, ctypes.c_double)
_POINTERS: Final = (
    "robot", "drive", "settings", "chassis", "stall", "energy", "ring", "echo", "bitgen", "normal",
)  # fmt: skip
_NUMBERS: Final = (
    "swing_mm", "track_mm", "accel_top", "rotaccel_top", "mass_kg", "inertia", "rad2", "accel_factor",
    "noise_mm", "noise_part", "crosstalk", "min_mm", "no_echo_mm",
)  # fmt: skip


class _Wait(ctypes.Structure):
    _fields_ = [("value", ctypes.c_double), ("sign", ctypes.c_double), ("variable", ctypes.c_int32)]


class _Parts(ctypes.Structure):
    _fields_ = [
        *((name, ctypes.c_void_p) for name in _POINTERS),
        ("learn", _LEARN),
        ("movers", ctypes.c_void_p),
        ("others", ctypes.c_void_p),
        ("closing_mm", ctypes.c_double),
        *((name, ctypes.c_double) for name in _NUMBERS),
        ("mount", ctypes.c_void_p),
        *((name, ctypes.c_int64) for name in ("watchdog_ms", "resume_ms")),
        *((name, ctypes.c_int32) for name in ("bumper_mask", "stalls_front", "stalls_rear", "waits")),
        ("afflicted", ctypes.c_uint64),
        ("wait", _Wait * _WAITS),
        ("sonar_on", ctypes.c_bool),
        ("ready", ctypes.c_bool),
    ]


def _normal() -> int | None:
    """Where numpy keeps the function that draws what `standard_normal` draws; None where it shows none."""
    try:
        found = ctypes.CDLL(np.random._generator.__file__).random_standard_normal
    except (AttributeError, OSError):
        return None
    return ctypes.cast(found, ctypes.c_void_p).value


@dataclass
class Parts:
    """What a robot is made of."""

    clock: RobotState
    table: RobotTable
    drive: Drive
    chassis: Chassis
    stall: StallMonitor
    energy: Energy
    ring: Ring
    faults: Faults | None
    moving: Moving | None


class Ticks:
    """The sub-steps of one robot that C can do."""

    def __init__(self, robot: Parts, ring: SonarRing, run: Callable[..., bool], normal: int) -> None:
        """`run`: the function in C. `normal`: that of numpy's that draws normal numbers."""
        self._clock, self._drive, self._ring, self._run = robot.clock, robot.drive, ring, run
        self._faults = robot.faults if isinstance(robot.faults, FaultSet) else None
        motion, params = robot.table.motion, ring.params
        self._learn = _LEARN(ring.echoes.learn)
        self._mount = np.array(
            [(m.x_mm, m.y_mm, m.heading_deg) for m in robot.table.mounts], dtype=np.float64
        )
        self._bitgen = ring.rng.bit_generator.ctypes
        self._parts = _Parts(
            robot=ctypes.addressof(robot.clock),
            drive=ctypes.addressof(robot.drive),
            chassis=ctypes.addressof(robot.chassis),
            stall=ctypes.addressof(robot.stall),
            energy=ctypes.addressof(robot.energy),
            ring=ctypes.addressof(ring),
            echo=ring.echoes.handle,
            bitgen=self._bitgen.bit_generator.value,
            normal=normal,
            learn=self._learn,
            swing_mm=robot.table.body.swing_mm,
            track_mm=motion["track_mm"],
            accel_top=motion["accel_top_mm_s2"],
            rotaccel_top=motion["rotaccel_top_deg_s2"],
            mass_kg=MASS_KG,
            inertia=INERTIA_KG_M2,
            rad2=math.radians(1) ** 2,
            accel_factor=ACCEL_FACTOR,
            noise_mm=params.noise_mm,
            noise_part=params.noise_part,
            crosstalk=params.crosstalk,
            min_mm=MIN_MM,
            no_echo_mm=NO_ECHO_MM,
            mount=self._mount.ctypes.data,
            watchdog_ms=TIMING["WATCHDOG_MS"],
            resume_ms=RESUME_MS,
            bumper_mask=SIP["BUMPER_MASK"],
            stalls_front=BUMPSTALL["FRONT"],
            stalls_rear=BUMPSTALL["REAR"],
            afflicted=0 if ring.is_plain else _ALL,
        )
        if ring.moving is not None and ring.others is not None:
            self._parts.movers, self._parts.others = ctypes.addressof(ring.moving), ring.others.for_c()
            self._parts.closing_mm = ring.moving.fastest_mm_s * STEP_S
        self.address = ctypes.addressof(self._parts)

    def run(self, stop_ms: float, limit_ms: float) -> bool:
        """Let sub-steps pass until `stop_ms`, none beyond `limit_ms`; False: the next one is for Python."""
        self.prepare()
        return self._run(self.address, stop_ms, limit_ms)

    def prepare(self) -> None:
        """Let C know what only Python changes; and what it has to leave to Python for now, which may be all."""
        ring, parts = self._ring, self._parts
        parts.ready = not ring.switched and (self._faults is None or self._await(self._faults))
        if parts.ready:
            ring.hand_over()
            parts.settings = ctypes.addressof(self._drive.settings)
            parts.sonar_on = any(ring.enabled)

    def _await(self, faults: FaultSet) -> bool:
        waits = faults.waits(self._clock.now_ms)
        if waits is None or len(waits) > _WAITS:
            return False
        for place, when in zip(self._parts.wait, waits, strict=False):
            place.value, place.sign, place.variable = when.value, when.sign, _VARIABLES.index(when.variable)
        self._parts.waits = len(waits)
        if self._ring.is_plain:
            self._parts.afflicted = faults.afflicted
        return True

    def heard(self) -> Sequence[SonarReading]:
        """Return the readings that came in since the last call."""
        return self._ring.take_heard()

    def hold(self, readings: Sequence[Reading]) -> None:
        """Let C put these into the next SIP."""
        self._ring.hold(readings)


def ticks_of(robot: Parts) -> Ticks | None:
    """Return the sub-steps that C can do of a robot; None where there are none, since more goes on in each."""
    ring, normal = robot.ring, _normal()
    found = native.library()
    if found is None or normal is None or not isinstance(ring, SonarRing) or ring.echoes.handle is None:
        return None
    if robot.chassis.is_special or not isinstance(robot.faults, FaultSet | None):
        return None
    if robot.moving is not ring.moving or (ring.moving is not None and not ring.moving.fits_c):
        return None
    return Ticks(robot, ring, found.argus_sim_run, normal)
