# SPDX-License-Identifier: MIT
"""Sonars as recordings of real ones have them: quiet, a wave late now and then, deaf to some surfaces.

What a sonar misses or hears too near is settled by where the echo comes from and where the robot is, so that it stays
while the world is still. One random number is drawn for every ping, whatever happens to it.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np

from hil_sim.sonar.params import MIN_MM, NO_ECHO_MM
from hil_sim.tables import load
from hil_sim.world.model import Pose

_WORD: Final = (1 << 64) - 1
_UNIT: Final = 2.0**-64


def _share(salt: int, *numbers: int) -> float:
    """Return a number from 0 to 1 that depends on these alone, evenly (splitmix64)."""
    word = salt
    for number in numbers:
        word = (word + 0x9E3779B97F4A7C15 + number) & _WORD
        word = ((word ^ (word >> 30)) * 0xBF58476D1CE4E5B9) & _WORD
        word = ((word ^ (word >> 27)) * 0x94D049BB133111EB) & _WORD
        word ^= word >> 31
    return word * _UNIT


class Recorded:
    """The statistics of one robot's sonars in one run, drawn from hil_sim/tables/recorded.toml."""

    def __init__(
        self, strength: float, sonars: int, rng: np.random.Generator, *, hears_all: bool = False
    ) -> None:
        """`strength`: 1 is as in the recordings; less keeps some of the plain model's noise, and lowers the shares.

        hears_all: the ranges are not of the plain model, which is silent for a part of it by itself.
        """
        table: dict[str, Any] = load("recorded")
        rest, silence, near = table["rest"], table["silence"], table["near"]
        self.strength = strength
        self._salt = int(rng.integers(1 << 63))
        self.jitter_mm = [float(v) for v in rng.choice(rest["jitter_mm"], sonars)]
        self.late = [strength * float(v) for v in rng.choice(rest["late"], sonars)]
        model = 0.0 if hears_all else float(silence["model"])
        missed = [max(0.0, (float(v) - model) / (1 - model)) for v in rng.choice(silence["by_sonar"], sonars)]
        self.missed = [strength * share for share in missed]
        self._step_mm = float(rest["step_mm"])
        self._patch_mm, self._heard_mm = float(silence["patch_mm"]), float(silence["heard_mm"])
        self._near = strength * float(near["share"])
        self._place_mm, self._place_deg = float(near["place_mm"]), float(near["place_deg"])
        self._random = rng.random

    def draw(self) -> float:
        """Draw for one ping: how many waves late it is, by `measured`."""
        return self._random()

    def heard(self, number: int, robot: Pose, from_: Pose, range_mm: float) -> float:
        """Return what the sonar makes of an echo: nothing, the echo, or one of something nearer that no other sees."""
        place = (
            number,
            math.floor(robot.x_mm / self._place_mm),
            math.floor(robot.y_mm / self._place_mm),
            math.floor(robot.heading_deg % 360 / self._place_deg),
        )
        if _share(self._salt, 1, *place) < self._near:
            return MIN_MM + _share(self._salt, 2, *place) * (range_mm - MIN_MM)
        return NO_ECHO_MM if self._misses(number, from_, range_mm) else range_mm

    def _misses(self, number: int, from_: Pose, range_mm: float) -> bool:
        """Whether the patch that the echo is from is too soft for this sonar; a worse one misses more patches."""
        if not self._heard_mm <= range_mm < NO_ECHO_MM:
            return False
        heading = math.radians(from_.heading_deg)
        column = math.floor((from_.x_mm + range_mm * math.cos(heading)) / self._patch_mm)
        row = math.floor((from_.y_mm + range_mm * math.sin(heading)) / self._patch_mm)
        return _share(self._salt, 3, column, row) < self.missed[number]

    def measured(self, number: int, range_mm: float, noise_mm: float, noise: float, late: float) -> float:
        """Return the measured range of an echo. noise_mm: of the plain model; noise, late: as drawn."""
        spread = self.strength * self.jitter_mm[number] + (1 - self.strength) * noise_mm
        share, waves = self.late[number], 0
        while late < share and waves < 3:  # a weak echo crosses the threshold a wave later, seldom two
            waves += 1
            late /= share
        return range_mm + noise * spread + waves * self._step_mm
