# SPDX-License-Identifier: MIT
"""What a real sonar makes of an echo: gain, scale, dropouts, double bounce, steps, and what is too near.

Two random numbers are drawn for every ping, whatever happens to it, so that a fault or a world changes no later draw.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from hil_sim.sonar.params import MIN_MM, NO_ECHO_MM
from hil_sim.sonar.recorded import Recorded
from hil_sim.world.physics import Physics

_REPETITIONS: Final = 3
"""A sound that goes to and fro between surface and robot more often is too faint."""


class Roughness:
    """The departures from the plain model of one robot's sonars in one run."""

    def __init__(
        self, physics: Physics, sonars: int, rng: np.random.Generator, *, hears_all: bool = False
    ) -> None:
        """hears_all: the ranges come from what a laser sees, so all silence is to be drawn."""
        self.physics = physics
        self._random = rng.random
        self.gain_db = [float(v) for v in rng.uniform(-1.0, 1.0, sonars) * physics.gain_db]
        sound = 1.0 + float(rng.uniform(-1.0, 1.0)) * physics.sound
        scales = 1.0 + rng.uniform(-1.0, 1.0, sonars) * physics.range_scale
        self.scale = [float(v) * sound for v in scales]
        # A stream of its own: without it the other draws are as before.
        on = physics.as_recorded
        self.recorded = Recorded(on, sonars, rng.spawn(1)[0], hears_all=hears_all) if on else None

    def draw(self) -> tuple[bool, bool]:
        """Draw for one ping: whether it hears nothing, and whether it hears a double bounce if there is one."""
        lost, bounced = self._random(), self._random()
        return lost < self.physics.dropout, bounced < self.physics.double_bounce

    def heard(self, number: int, range_mm: float) -> float:
        """Return what a sonar makes of an echo from this distance."""
        if range_mm >= NO_ECHO_MM:
            return range_mm
        blind_mm = self.physics.blind_mm
        if range_mm < blind_mm:
            again = [k * range_mm for k in range(2, _REPETITIONS + 1) if k * range_mm >= blind_mm]
            if not again:
                return NO_ECHO_MM
            range_mm = again[0]
        return range_mm * self.scale[number]

    def stepped(self, range_mm: int) -> int:
        """Return a range in the steps in which the sonar measures."""
        step_mm = self.physics.range_step_mm
        if not step_mm or range_mm >= NO_ECHO_MM:
            return range_mm
        return min(NO_ECHO_MM, max(MIN_MM, round(round(range_mm / step_mm) * step_mm)))
