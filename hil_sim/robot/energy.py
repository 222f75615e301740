# SPDX-License-Identifier: MIT
"""What the robot draws from its battery and what that leaves of the voltage."""

from __future__ import annotations

import math
from typing import Final

from hil_sim.robot.state import EnergyState
from hil_sim.tables import load

_ENERGY: Final = load("energy")
IDLE_W: Final[float] = _ENERGY["power"]["idle_w"]
SONAR_W: Final[float] = _ENERGY["power"]["sonar_w"]
WHEEL_J_M: Final[float] = _ENERGY["power"]["wheel_j_per_m"]
ACCEL_FACTOR: Final[float] = _ENERGY["power"]["accel_factor"]
MASS_KG: Final[float] = _ENERGY["inertia"]["mass_kg"]
INERTIA_KG_M2: Final[float] = _ENERGY["inertia"]["turn_kg_m2"]
BATTERY: Final[dict[str, float]] = _ENERGY["battery"]


class Energy(EnergyState):
    """Energy account; kept apart so that the idle power can be rescaled afterwards."""

    @property
    def total_j(self) -> float:
        """Everything drawn so far."""
        return self.idle_s * IDLE_W + self.sonar_s * SONAR_W + self.wheel_m * WHEEL_J_M + self.accel_j

    def drive(self, wheels_mm: float, v: float, w: float, v_old: float, w_old: float) -> None:
        """Account for one sub-step: the path of both wheels, and speeds now and before (mm/s, deg/s)."""
        self.wheel_m += wheels_mm / 1000
        turning = INERTIA_KG_M2 * (w * w - w_old * w_old) * math.radians(1) ** 2 / 2
        gained = MASS_KG * (v * v - v_old * v_old) / 2e6 + turning
        if gained > 0:
            self.accel_j += gained * ACCEL_FACTOR

    def battery_v(self, sonar_on: bool, wheels_mm_s: float) -> float:
        """Terminal voltage: falls with the charge used and with the load of now."""
        used = min(1.0, self.total_j / (BATTERY["capacity_wh"] * 3600))
        open_v = BATTERY["full_v"] - (BATTERY["full_v"] - BATTERY["empty_v"]) * used
        watts = IDLE_W + sonar_on * SONAR_W + WHEEL_J_M * wheels_mm_s / 1000
        return open_v - watts / open_v * BATTERY["internal_ohm"]
