# SPDX-License-Identifier: MIT
"""Scans of a laser in a world, and what the fault manager takes of one: the nearest return in each sector."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from hil_sim.tables.robot import RobotTable
from hil_sim.world.model import Floats, Pose, World

NOISE_MM: Final = 10.0
_PARALLEL: Final = 1e-9


@dataclass(frozen=True)
class Laser:
    """Where it stands on the robot, what it sees, and its beams; of a SICK LMS200 unless said otherwise."""

    x_mm: float = 20.0
    y_mm: float = 0.0
    facing_deg: float = 0.0
    field_deg: float = 180.0
    beams: int = 181
    most_mm: float = 8000.0
    noise_mm: float = NOISE_MM

    @property
    def angles(self) -> Floats:
        """The bearings of its beams on the robot, rad, from right to left."""
        half = self.field_deg / 2
        return np.radians(self.facing_deg + np.linspace(-half, half, self.beams))


def laser_of(table: RobotTable) -> Laser:
    """Return the laser of a robot whose ring has one, with a beam for each degree."""
    first, field = table.mounts[table.sectors[0]], table.sector_deg * len(table.sectors)
    facing = first.heading_deg - (field - table.sector_deg) / 2
    return Laser(first.x_mm, first.y_mm, facing, field, field + 1)


def cast(world: World, x_mm: float, y_mm: float, bearings: Floats) -> Floats:
    """Return how far the nearest solid is along each bearing, mm; inf where there is none."""
    x1, y1, x2, y2 = world.segments.T[:, :, None]
    dx, dy = np.cos(bearings)[None, :], np.sin(bearings)[None, :]
    ex, ey = x2 - x1, y2 - y1
    cross = dx * ey - dy * ex
    with np.errstate(divide="ignore", invalid="ignore"):
        far = ((x1 - x_mm) * ey - (y1 - y_mm) * ex) / cross
        along = ((x1 - x_mm) * dy - (y1 - y_mm) * dx) / cross
    hit = (np.abs(cross) > _PARALLEL) & (far > 0) & (along >= 0) & (along <= 1)
    found: Floats = np.where(hit, far, np.inf).min(axis=0)
    return found


def scan(laser: Laser, world: World, pose: Pose, rng: np.random.Generator) -> Floats:
    """Return the ranges of its beams, mm, with noise; inf: nothing returned."""
    heading = math.radians(pose.heading_deg)
    x_mm = pose.x_mm + laser.x_mm * math.cos(heading) - laser.y_mm * math.sin(heading)
    y_mm = pose.y_mm + laser.x_mm * math.sin(heading) + laser.y_mm * math.cos(heading)
    ranges = cast(world, x_mm, y_mm, laser.angles + heading)
    ranges = np.where(ranges < laser.most_mm, ranges, np.inf)
    return ranges + rng.normal(0.0, laser.noise_mm, len(ranges))


class Beams:
    """Which beams of a scan look into which sector of a robot's laser; angles: of the beams on the robot, rad."""

    def __init__(self, table: RobotTable, angles: Floats) -> None:
        self._of: list[tuple[int, npt.NDArray[np.intp]]] = []
        half = math.radians(table.sector_deg) / 2
        for number in table.sectors:
            off = angles - math.radians(table.mounts[number].heading_deg)
            within = np.flatnonzero(np.abs(np.arctan2(np.sin(off), np.cos(off))) <= half)
            if within.size:
                self._of.append((number, within))

    def nearest(self, ranges_mm: Floats) -> dict[int, float]:
        """Return the nearest return in each sector, mm; inf: none. What no beam looks into is left out.

        A range that is no return is inf.
        """
        return {number: float(ranges_mm[within].min()) for number, within in self._of}
