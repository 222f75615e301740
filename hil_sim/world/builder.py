# SPDX-License-Identifier: MIT
"""Collects the segments of a world while its file is read."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from hil_sim.world.model import World

MAX_SEGMENTS: Final = 200_000
_SHORTEST_MM: Final = 1e-3
"""Two points nearer than this are one."""


class Builder:
    """Collects segments while a file is read."""

    def __init__(self) -> None:
        self.rows: list[tuple[float, float, float, float]] = []
        self.rough: list[float] = []

    def line(self, points: list[tuple[float, float]], roughness: float, closed: bool = False) -> None:
        """Add the segments between consecutive points."""
        ends = points[1:] + points[:1] if closed else points[1:]
        for (x1, y1), (x2, y2) in zip(points, ends, strict=False):
            if math.hypot(x2 - x1, y2 - y1) > _SHORTEST_MM:
                self.rows.append((x1, y1, x2, y2))
                self.rough.append(roughness)

    def world(self, name: str, **rest: object) -> World:
        """Make the world."""
        segments = np.array(self.rows, dtype=np.float64).reshape(-1, 4)
        return World(name, segments, np.array(self.rough, dtype=np.float64), **rest)  # type: ignore[arg-type]


def turned(x: float, y: float, angle: float) -> tuple[float, float]:
    """Return a point turned about the origin by `angle` rad."""
    c, s = math.cos(angle), math.sin(angle)
    return x * c - y * s, x * s + y * c
