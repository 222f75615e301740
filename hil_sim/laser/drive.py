# SPDX-License-Identifier: MIT
"""A robot that roams about a world by itself: where it is, ten times a second, and what its odometry says."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Final, NamedTuple

import numpy as np

from hil_sim.laser.scan import cast
from hil_sim.world.model import Pose, World

STEP_S: Final = 0.1
_SPEED_MM_S: Final = 300.0
_TURN_DEG_S: Final = 45.0
_NEAR_MM: Final = 800.0
_FREE_MM: Final = 1300.0
_SIDE_MM: Final = 330.0
_ROUND: Final = np.radians(np.arange(-180, 180, 5))
_AHEAD: Final = np.abs(_ROUND) <= math.radians(32)
_SCALE_SIGMA: Final = 0.01
_TURN_SIGMA: Final = 0.02


class Step(NamedTuple):
    """One moment: true pose, pose by odometry, speed ahead and turn."""

    t_ms: int
    true: Pose
    odometry: Pose
    speed_mm_s: float
    turn_deg_s: float


def roam(world: World, start: Pose, seconds: float, rng: np.random.Generator) -> Iterator[Step]:
    """Yield steps. Ahead while there is room, else a turn to the freer side; odometry is off by a percent or two."""
    scale, turn_scale = 1 + rng.normal(0, _SCALE_SIGMA), 1 + rng.normal(0, _TURN_SIGMA)
    x, y, heading = start
    ox = oy = oh = 0.0
    way_round = 0.0
    wobble = rng.uniform(0, math.tau)
    for n in range(int(seconds / STEP_S)):
        around = cast(world, x, y, _ROUND + math.radians(heading))
        ahead = float(around[_AHEAD].min())
        side = float(around.min())
        if way_round and ahead > _FREE_MM:
            way_round = 0.0
        elif not way_round and (ahead < _NEAR_MM or side < _SIDE_MM):
            left, right = around[_ROUND > 0], around[_ROUND < 0]
            way_round = 1.0 if np.minimum(left, 4000).mean() > np.minimum(right, 4000).mean() else -1.0
        speed = 0.0 if way_round else _SPEED_MM_S
        turn = way_round * _TURN_DEG_S if way_round else 6.0 * math.sin(n * 0.05 + wobble)
        yield Step(n * 100, Pose(x, y, heading), Pose(ox, oy, oh), speed, turn)
        middle = math.radians(heading + turn * STEP_S / 2)
        x += speed * STEP_S * math.cos(middle)
        y += speed * STEP_S * math.sin(middle)
        heading += turn * STEP_S
        middle = math.radians(oh + turn * turn_scale * STEP_S / 2)
        ox += speed * scale * STEP_S * math.cos(middle)
        oy += speed * scale * STEP_S * math.sin(middle)
        oh += turn * turn_scale * STEP_S
