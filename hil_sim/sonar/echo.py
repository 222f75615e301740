# SPDX-License-Identifier: MIT
"""Echoes: the nearest within a beam cone that is loud enough, from smooth and rough surfaces."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from hil_sim import native
from hil_sim.sonar import kernel
from hil_sim.sonar.params import MIN_MM, NO_ECHO_MM, SonarParams, transducer_pose
from hil_sim.sonar.patch import MovingEchoes, Patch, find_corners
from hil_sim.tables.robot import RobotTable, robot_table
from hil_sim.world.model import Floats, Pose, World

_RAY_STEP_DEG: Final = 1.5
_CELL_MM: Final = 500.0
_TOUCH: Final = 1e-9
_SMOOTH: Final = 0.25
"""Part of mirror_db_deg2 from which on a surface is smooth: that of a roughness of 0.5."""


class EchoModel:
    """Ranges that a transducer reads in a world: the nearest echo within its cone that is loud enough.

    Computed in C when the library is there, else here with numpy; to the same mm.
    """

    def __init__(
        self,
        world: World,
        params: SonarParams,
        robot: RobotTable | None = None,
        *,
        in_c: bool = True,
    ) -> None:
        """`robot`: the one with these sonars; None is the one that is emulated by default."""
        self.params = params
        self._mounts = (robot if robot is not None else robot_table()).mounts
        self._segments = world.segments
        self._roughness = world.roughness
        self._corners = find_corners(world.segments)
        self._patches: dict[tuple[int, int], Patch] = {}
        half = params.cone_deg / 2
        count = 2 * max(1, math.ceil(half / _RAY_STEP_DEG)) + 1
        offsets = np.linspace(-half, half, count)
        self._ray_db = params.edge_db * (offsets / half) ** 2
        if params.side_lobe_db > 0 and params.side_lobe_deg / 2 > half:
            offsets, half = self._with_side_lobes(offsets)
        self._ray_cos, self._ray_sin = np.cos(np.radians(offsets)), np.sin(np.radians(offsets))
        self._cos_half = math.cos(math.radians(half))
        self._kernel = self._new_kernel() if in_c and native.library() is not None else None

    def _with_side_lobes(self, offsets: Floats) -> tuple[Floats, float]:
        """Add rays beside the cone, which lose as much everywhere; return all of them, and half the width then."""
        half, wide = self.params.cone_deg / 2, self.params.side_lobe_deg / 2
        beside = np.linspace(half, wide, 1 + max(1, math.ceil((wide - half) / _RAY_STEP_DEG)))[1:]
        self._ray_db = np.concatenate((self._ray_db, np.full(2 * len(beside), self.params.side_lobe_db)))
        return np.concatenate((offsets, beside, -beside)), wide

    def _new_kernel(self) -> kernel.Kernel:
        numbers = vars(self.params) | {
            "cos_half": self._cos_half,
            "air_db_mm": self.params.air_db_m / 1000,
            "min_mm": MIN_MM,
            "no_echo_mm": NO_ECHO_MM,
            "cell_mm": _CELL_MM,
            "touch": _TOUCH,
        }
        mount = np.array([(p.x_mm, p.y_mm, p.heading_deg) for p in self._mounts])
        # From the axis outwards: what is heard there mostly settles what the rays further out could add.
        order = np.argsort(self._ray_db, kind="stable")
        rays = {f"ray_{name}": getattr(self, f"_ray_{name}")[order] for name in ("cos", "sin", "db")}
        return kernel.Kernel(numbers, rays | {"mount": mount})

    @property
    def handle(self) -> int | None:
        """The same model in C, if there is one."""
        return self._kernel.handle if self._kernel is not None else None

    def learn(self, x_mm: float, y_mm: float) -> None:
        """Let C know the cell of a place."""
        self._patch(x_mm, y_mm)

    def ping_mm(
        self,
        number: int,
        pose: Pose,
        angle_deg: float = 0.0,
        moving: MovingEchoes | None = None,
        gain_db: float = 0.0,
    ) -> int:
        """Return what a sonar of a robot at `pose` reads, its axis turned by `angle_deg`, its gain off by `gain_db`."""
        if self._kernel is not None:
            patch = moving.patch(True).for_c if moving is not None else None
            value = self._kernel.ping_mm(
                number, pose.x_mm, pose.y_mm, pose.heading_deg, angle_deg, gain_db, patch
            )
            if value >= 0:
                return value
        at = transducer_pose(self._mounts[number], pose)
        return self.range_mm(at.x_mm, at.y_mm, at.heading_deg + angle_deg, moving, gain_db)

    def range_mm(
        self,
        x_mm: float,
        y_mm: float,
        heading_deg: float,
        moving: MovingEchoes | None = None,
        gain_db: float = 0.0,
    ) -> int:
        """Return the range from a transducer at this place, 100 to 5000; 5000 when nothing is heard.

        Cost: about 1 us in C, 80 us with numpy, in a world of some 30 segments.
        """
        if self._kernel is None:
            patch = self._patch(x_mm, y_mm)
            if moving is not None:
                patch = patch.joined(moving.patch(False))
            return self._range_numpy(patch, x_mm, y_mm, heading_deg, gain_db)
        others = moving.patch(True).for_c if moving is not None else None
        value = self._kernel.range_mm(x_mm, y_mm, heading_deg, gain_db, others)
        if value == kernel.UNKNOWN_CELL:
            self._patch(x_mm, y_mm)
            value = self._kernel.range_mm(x_mm, y_mm, heading_deg, gain_db, others)
        return value

    def bounce_mm(
        self, number: int, pose: Pose, angle_deg: float = 0.0, moving: MovingEchoes | None = None
    ) -> int | None:
        """Return the way along the axis by way of a smooth surface to the next one; None when none is within 5 m.

        The same with and without the library: it is seldom asked for.
        """
        at = transducer_pose(self._mounts[number], pose)
        patch = self._patch(at.x_mm, at.y_mm)
        if moving is not None:
            patch = patch.joined(moving.patch(self._kernel is not None))
        heading = math.radians(at.heading_deg + angle_deg)
        dx, dy = math.cos(heading), math.sin(heading)
        first = _cast(patch, at.x_mm, at.y_mm, dx, dy, -1)
        if first is None:
            return None
        way, k = first
        if patch.mirror[k] <= self.params.mirror_db_deg2 * _SMOOTH:
            return None
        along_x, along_y = float(patch.ex[k] / patch.length[k]), float(patch.ey[k] / patch.length[k])
        along = dx * along_x + dy * along_y
        mirrored = 2 * along * along_x - dx, 2 * along * along_y - dy
        second = _cast(patch, at.x_mm + way * dx, at.y_mm + way * dy, *mirrored, k)
        if second is None or way + second[0] >= NO_ECHO_MM:
            return None
        return round(way + second[0])

    def _range_numpy(self, patch: Patch, x_mm: float, y_mm: float, heading_deg: float, gain_db: float) -> int:
        if len(patch.ax) == 0:
            return NO_ECHO_MM
        heading = math.radians(heading_deg)
        c, s = math.cos(heading), math.sin(heading)
        dir_x = self._ray_cos * c - self._ray_sin * s
        dir_y = self._ray_cos * s + self._ray_sin * c
        beam_db = self._ray_db
        far, tip_db = self._seen_corners(patch, x_mm, y_mm, c, s)
        if far is not None:
            dir_x, dir_y = np.concatenate((dir_x, far[0])), np.concatenate((dir_y, far[1]))
            beam_db = np.concatenate((beam_db, far[3]))
        wx, wy = patch.ax - x_mm, patch.ay - y_mm
        across, up = dir_x[:, None], dir_y[:, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            # Products one by one, not as a matrix: their rounding is then the same on every machine, and in C.
            inverse = 1.0 / (across * patch.ey - up * patch.ex)
            where = (up * wx - across * wy) * inverse
            ranges = (wx * patch.ey - wy * patch.ex) * inverse
            # Written so that a ray along a segment (NaN) misses it.
            hit = (where >= -_TOUCH) & (where <= 1 + _TOUCH) & (ranges > 0)
        ranges[~hit] = np.inf
        first = ranges.argmin(axis=1)
        index = np.arange(len(first))
        nearest = ranges[index, first]
        with np.errstate(divide="ignore", invalid="ignore"):
            cosine = np.abs(1.0 / (inverse[index, first] * patch.length[first]))
            degrees = np.degrees(np.arccos(np.minimum(cosine, 1.0)))
            loss = patch.mirror[first] * degrees**2 - 20 * np.log10(cosine)
            if far is not None:
                count = len(tip_db)
                reached = nearest[-count:] >= far[2] - 1.0
                nearest[-count:] = np.where(reached, far[2], nearest[-count:])
                loss[-count:] = np.where(reached, np.fmin(loss[-count:], tip_db), loss[-count:])
            # NaN where nothing was hit and the air takes nothing: not heard either.
            loss = loss + beam_db + self.params.air_db_m / 1000 * nearest
        heard = nearest[loss <= self.params.margin_db + gain_db]
        if heard.size == 0:
            return NO_ECHO_MM
        return int(min(NO_ECHO_MM, max(MIN_MM, round(float(heard.min())))))

    def _seen_corners(
        self, patch: Patch, x: float, y: float, c: float, s: float
    ) -> tuple[tuple[Floats, Floats, Floats, Floats] | None, Floats]:
        """Directions, distances, beam losses and own losses of the corners within the cone.

        Rays are sent to them so that nothing thin falls between the rays of the fan.
        """
        dx, dy = patch.corner_x - x, patch.corner_y - y
        distance = np.sqrt(dx * dx + dy * dy)
        along = dx * c + dy * s
        inside = np.flatnonzero(
            (along >= self._cos_half * distance) & (distance > 1.0) & (distance < NO_ECHO_MM)
        )
        if inside.size == 0:
            return None, distance
        dx, dy, distance, along = dx[inside], dy[inside], distance[inside], along[inside]
        dx, dy = dx / distance, dy / distance
        off = np.degrees(np.arccos(np.minimum(along / distance, 1.0))) * 2 / self.params.cone_deg
        inverse = patch.inverse[inside]
        # The transducer looks into the corner when the way back is a positive mix of the corner's arms.
        into = (inverse[:, 0] * dx + inverse[:, 1] * dy < 0) & (inverse[:, 2] * dx + inverse[:, 3] * dy < 0)
        own = np.where(into & (patch.retro[inside] > 0), self.params.corner_db, self.params.tip_db)
        beam_db = self.params.edge_db * off * off
        if self.params.side_lobe_db > 0:
            beam_db = np.where(off > 1, self.params.side_lobe_db, beam_db)
        return (dx, dy, distance, beam_db), own

    def _patch(self, x: float, y: float) -> Patch:
        cell = (math.floor(x / _CELL_MM), math.floor(y / _CELL_MM))
        patch = self._patches.get(cell)
        if patch is None:
            centre_x, centre_y = (cell[0] + 0.5) * _CELL_MM, (cell[1] + 0.5) * _CELL_MM
            limit = NO_ECHO_MM + _CELL_MM
            near = _distances(self._segments, centre_x, centre_y) <= limit
            away = np.hypot(self._corners[:, 0] - centre_x, self._corners[:, 1] - centre_y) <= limit
            patch = Patch(self._segments[near], self._roughness[near], self._corners[away], self.params)
            self._patches[cell] = patch
            if self._kernel is not None:
                self._kernel.add(cell, patch.for_c)
        return patch


def _distances(segments: Floats, x: float, y: float) -> Floats:
    ex, ey = segments[:, 2] - segments[:, 0], segments[:, 3] - segments[:, 1]
    wx, wy = x - segments[:, 0], y - segments[:, 1]
    t = np.clip((wx * ex + wy * ey) / (ex * ex + ey * ey), 0.0, 1.0)
    result: Floats = np.hypot(wx - t * ex, wy - t * ey)
    return result


def _cast(patch: Patch, x: float, y: float, dx: float, dy: float, without: int) -> tuple[float, int] | None:
    """The first segment that one ray meets: how far away and which; `without`: one that it passes through."""
    wx, wy = patch.ax - x, patch.ay - y
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = 1.0 / (dx * patch.ey - dy * patch.ex)
        where = (dy * wx - dx * wy) * inverse
        ranges = (wx * patch.ey - wy * patch.ex) * inverse
        hit = (where >= -_TOUCH) & (where <= 1 + _TOUCH) & (ranges > 0)
    if without >= 0:
        hit[without] = False
    if not hit.any():
        return None
    ranges[~hit] = np.inf
    k = int(ranges.argmin())
    return float(ranges[k]), k
