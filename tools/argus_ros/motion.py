# SPDX-License-Identifier: MIT
"""Where a robot is and how it moves."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class Motion:
    """m, rad, s."""

    x_m: float = 0.0
    y_m: float = 0.0
    heading_rad: float = 0.0
    speed_m_s: float = 0.0
    turn_rad_s: float = 0.0
