# SPDX-License-Identifier: MIT
"""The simulated laser of the vendor's emulator: a scan behind each SIP, in parts, once a client asks for it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from hil_sim.arcos import SimLaser
from hil_sim.laser.scanner import Scanner
from hil_sim.robot.chassis import wrapped
from hil_sim.robot.robot import Robot

PART: Final = 32
"""So many ranges are in a packet at the most."""
EXTENDED: Final = 2
BEAMS_MOST: Final = 0xFFFF
FIELD_MOST_DEG: Final = 360
_NUMBER_AND_FLAGS: Final = bytes(2)


class LaserPort:
    """What a client has asked of the laser: on, field and step, degrees; the beams go from `start` to `end`."""

    def __init__(self, scanner: Scanner) -> None:
        self._scanner = scanner
        self.reset()

    def reset(self) -> None:
        """As before a session: off, the laser's own field."""
        laser = self._scanner.laser
        self.form = 0
        self.start_deg = laser.facing_deg - laser.field_deg / 2
        self.end_deg = laser.facing_deg + laser.field_deg / 2
        self.step_deg = laser.field_deg / (laser.beams - 1)

    def enable(self, form: int) -> None:
        """0: off; 2: in the extended form; any other number: on."""
        self.form = form

    def set_start(self, degrees: int) -> None:
        """Let the scan begin there."""
        self.start_deg = float(degrees)

    def set_end(self, degrees: int) -> None:
        """... and end there."""
        self.end_deg = float(degrees)

    def set_step(self, hundredths: int) -> None:
        """Set how far apart the beams are, hundredths of a degree."""
        if hundredths > 0:
            self.step_deg = hundredths / 100

    @property
    def beams(self) -> int:
        """How many beams a scan has."""
        return math.floor(min(abs(self.end_deg - self.start_deg), FIELD_MOST_DEG) / self.step_deg + 1e-6) + 1

    def packets(self, robot: Robot) -> Iterator[SimLaser]:
        """Yield the scan of now; none while it is off."""
        if self.form == 0:
            return
        ranges = self._ranges(robot)
        odometry = robot.chassis
        place = (_word(odometry.odo_x), _word(odometry.odo_y), _word(wrapped(odometry.odo_th)))
        for first in range(0, len(ranges), PART):
            part = ranges[first : first + PART]
            if self.form == EXTENDED:
                yield SimLaser(len(ranges), first, part, None, (0,) * len(part), _NUMBER_AND_FLAGS)
            else:
                yield SimLaser(len(ranges), first, part, place)

    def _ranges(self, robot: Robot) -> tuple[int, ...]:
        """Return the ranges from `start` to `end`, mm; nothing returned is the greatest range."""
        laser, beams = self._scanner.laser, self.beams
        field = (beams - 1) * self.step_deg
        low = self.start_deg if self.end_deg >= self.start_deg else self.start_deg - field
        looks = replace(laser, facing_deg=low + field / 2, field_deg=field, beams=beams)
        found = np.clip(np.round(self._scanner.scan(robot.pose, looks)), 0, round(laser.most_mm))
        millimetres = tuple(int(mm) for mm in found)
        return millimetres if self.end_deg >= self.start_deg else millimetres[::-1]


def _word(value: float) -> int:
    """Return a number as 16 bits have it, with its sign."""
    return (round(value) + 0x8000 & 0xFFFF) - 0x8000
