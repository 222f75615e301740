# SPDX-License-Identifier: MIT
"""The solids that can be heard from one place, as arrays ready for use; those in motion too."""

from __future__ import annotations

import ctypes
import math

import numpy as np

from hil_sim.sonar import kernel
from hil_sim.sonar.params import SonarParams
from hil_sim.sonar.state import OthersState
from hil_sim.world.model import Floats
from hil_sim.world.moving import MovingSolids


class Patch:
    """The solids that can be heard from one grid cell, as arrays ready for use."""

    def __init__(self, segments: Floats, roughness: Floats, corners: Floats, params: SonarParams) -> None:
        self.ax, self.ay = segments[:, 0].copy(), segments[:, 1].copy()
        self.ex, self.ey = segments[:, 2] - self.ax, segments[:, 3] - self.ay
        self.length = np.hypot(self.ex, self.ey)
        rough = roughness if params.specular else np.ones_like(roughness)
        self.mirror = params.mirror_db_deg2 * (1 - rough) ** 2
        self.corner_x, self.corner_y = corners[:, 0].copy(), corners[:, 1].copy()
        self.inverse = corners[:, 2:6].copy()
        self.retro = corners[:, 6].copy()
        self._for_c: kernel.Patch | None = None

    @property
    def for_c(self) -> kernel.Patch:
        """The same for the kernel."""
        if self._for_c is None:
            self._for_c = kernel.Patch(vars(self))
        return self._for_c

    def joined(self, other: Patch) -> Patch:
        """Return both as one, this one first."""
        both = object.__new__(Patch)
        for name in kernel.PATCH_ARRAYS:
            setattr(both, name, np.concatenate((getattr(self, name), getattr(other, name))))
        return both


def find_corners(segments: Floats) -> Floats:
    """Ends of segments, each once: x, y, the inverse of the matrix of its two arms, 1 when it can send sound back.

    An inner corner of about a right angle returns sound the way it came to a sonar that looks into it.
    """
    arms: dict[tuple[float, float], list[tuple[float, float]]] = {}
    for x1, y1, x2, y2 in segments.tolist():
        length = math.hypot(x2 - x1, y2 - y1)
        ux, uy = (x2 - x1) / length, (y2 - y1) / length
        arms.setdefault((round(x1, 3), round(y1, 3)), []).append((ux, uy))
        arms.setdefault((round(x2, 3), round(y2, 3)), []).append((-ux, -uy))
    rows = []
    for (x, y), out in arms.items():
        row = [x, y, 0.0, 0.0, 0.0, 0.0, 0.0]
        if len(out) == 2:
            (a, b), (c, d) = out
            det, dot = a * d - b * c, a * c + b * d
            if abs(det) < 0.1 and dot < 0:
                continue  # a wall that goes straight on has no corner there
            if abs(dot) < 0.5:
                row[2:] = [d / det, -c / det, -b / det, a / det, 1.0]
        rows.append(row)
    return np.array(rows, dtype=np.float64).reshape(-1, 7)


class MovingEchoes(OthersState):
    """The solids in motion of one run, as a patch that follows them."""

    def __init__(self, moving: MovingSolids, params: SonarParams) -> None:
        super().__init__(_moment=-1)
        self._moving = moving
        corners = [find_corners(actor.shape) for actor in moving.actors]
        self._owner = moving.owner
        counts = [len(rows) for rows in corners]
        self._corner_owner = np.repeat(np.arange(len(counts), dtype=np.int32), counts)
        self._shape = Patch(moving.shape, moving.roughness, np.concatenate(corners), params)
        self._patch = Patch(moving.shape, moving.roughness, np.concatenate(corners), params)
        self._placer: kernel.Placer | None = None
        # A corner that sends sound back would have to turn with its owner; people and doors have none.
        assert not self._shape.retro.any()

    def patch(self, in_c: bool) -> Patch:
        """Return the solids as they are now: always the same arrays."""
        if self._moment != self._moving.moment:
            self._moment = self._moving.moment
            self._moving.place()
            if not in_c:
                self._place()
            else:
                if self._placer is None:
                    arrays = self._owner, self._corner_owner, self._moving.places
                    self._placer = kernel.Placer(self._patch.for_c, self._shape.for_c, *arrays)
                self._placer.place()
        return self._patch

    def for_c(self) -> int:
        """Return where C finds the same arrays."""
        self._here, self._forms = self._patch.for_c.address, self._shape.for_c.address
        self._owners, self._corner_owners = self._owner.ctypes.data, self._corner_owner.ctypes.data
        self._places = self._moving.places.ctypes.data
        return ctypes.addressof(self)

    def _place(self) -> None:
        here, shape = self._patch, self._shape
        places = self._moving.places
        x, y, c, s = places[self._owner].T
        here.ax[:] = x + shape.ax * c - shape.ay * s
        here.ay[:] = y + shape.ax * s + shape.ay * c
        here.ex[:] = shape.ex * c - shape.ey * s
        here.ey[:] = shape.ex * s + shape.ey * c
        x, y, c, s = places[self._corner_owner].T
        here.corner_x[:] = x + shape.corner_x * c - shape.corner_y * s
        here.corner_y[:] = y + shape.corner_x * s + shape.corner_y * c
