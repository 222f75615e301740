# SPDX-License-Identifier: MIT
"""A laser that scans one run's world: what stands in it, and what moves there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hil_sim.laser.scan import Laser, scan
from hil_sim.world.model import Floats, Pose, World
from hil_sim.world.moving import MovingSolids


class Scanner:
    """Scans of a laser in a world; `moving`: what else is in the way, which its owner lets move."""

    def __init__(
        self, laser: Laser, world: World, moving: MovingSolids | None, rng: np.random.Generator
    ) -> None:
        self.laser = laser
        self._world, self._moving, self._rng = world, moving, rng

    def scan(self, pose: Pose, laser: Laser | None = None) -> Floats:
        """Return the ranges of the beams from right to left, mm; inf: nothing returned. laser: looks otherwise."""
        return scan(laser or self.laser, self._now(pose), pose, self._rng)

    def _now(self, pose: Pose) -> World:
        if self._moving is None:
            return self._world
        near = self._moving.near(pose, self.laser.most_mm)
        if not near:
            return self._world
        segments: Floats = np.concatenate([self._world.segments, np.array(near)])
        return replace(self._world, segments=segments)
