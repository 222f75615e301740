# SPDX-License-Identifier: MIT
"""Worlds: solid line segments with a roughness, a start and goals."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from hil_sim.world.movers import Mover
from hil_sim.world.physics import PLAIN, Physics

Floats = npt.NDArray[np.float64]
POST_SIDES: Final = 8


class Pose(NamedTuple):
    """A place and a heading: mm, degrees counter-clockwise from the world's x axis."""

    x_mm: float
    y_mm: float
    heading_deg: float


ORIGIN: Final = Pose(0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False)
class World:
    """What is around the robot.

    segments: N x 4, x1 y1 x2 y2 in mm. roughness: N, 0 smooth (mirrors sound) to 1 rough (scatters it back).
    goals: places by name. forbidden: N x 4, lines that a map asks a planner to keep away from; not solid.
    physics: how sonars and wheels depart from the plain model, unless a scenario says otherwise.
    movers: people and doors, which are not among the segments.
    """

    name: str
    segments: Floats
    roughness: Floats
    start: Pose = ORIGIN
    goals: dict[str, Pose] = field(default_factory=dict)
    about: str = ""
    forbidden: Floats = field(default_factory=lambda: np.zeros((0, 4)))
    movers: tuple[Mover, ...] = ()
    physics: Physics = PLAIN

    @property
    def bounds(self) -> tuple[float, float, float, float]:
        """Smallest x, smallest y, largest x, largest y of the solids and the start."""
        xs = np.append(self.segments[:, 0::2].ravel(), self.start.x_mm)
        ys = np.append(self.segments[:, 1::2].ravel(), self.start.y_mm)
        return float(xs.min()), float(ys.min()), float(xs.max()), float(ys.max())
