# SPDX-License-Identifier: MIT
"""Speed profiles: one sub-step of a trapezoid, for translation in mm as for rotation in degrees."""

from __future__ import annotations

import math
from typing import Final

from hil_sim.world.step import STEP_S


def ramp(speed: float, target: float, accel: float, decel: float) -> float:
    """One sub-step from `speed` towards `target`."""
    if speed == target:
        return speed
    if speed * target < 0 or abs(target) < abs(speed):
        step = decel * STEP_S
        goal = 0.0 if speed * target < 0 else target
    else:
        step = accel * STEP_S
        goal = target
    return goal if abs(goal - speed) <= step else speed + math.copysign(step, goal - speed)


def approach(speed: float, left: float, top: float, accel: float, decel: float) -> tuple[float, bool]:
    """One sub-step towards a point `left` ahead; returns the new speed and whether the point is reached.

    The new speed is the highest from which the rest can still be braked away. So a trapezoid ends at rest on
    the point, and a point that is moved ahead in time leaves the speed as it is.
    """
    if left < 0:
        speed, done = approach(-speed, -left, top, accel, decel)
        return -speed, done
    if speed < 0:
        return min(0.0, speed + decel * STEP_S), False
    step = decel * STEP_S
    rest = left - speed * STEP_S / 2
    safe = math.sqrt(step * step / 4 + 2 * decel * rest) - step / 2 if rest > 0 else 0.0
    new = min(speed + accel * STEP_S, top, safe) if speed <= top else min(max(top, speed - step), safe)
    if new < speed - step:
        return speed - step, False
    # Less than one braking step is left: taking it whole ends exactly on the point.
    return (0.0, True) if safe <= 0 or left <= step * STEP_S / 2 else (new, False)


NEAR: Final = 0.5
"""A place is reached when no more than this is left, mm or degrees."""


def proportional(
    speed: float, left: float, top: float, accel: float, decel: float, gain: float
) -> tuple[float, bool]:
    """One sub-step of a controller whose speed is `gain` (1/s) times what is left; returns as `approach`."""
    if abs(left) <= NEAR:
        return 0.0, True
    return ramp(speed, max(-top, min(top, gain * left)), accel, decel), False
