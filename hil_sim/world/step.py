# SPDX-License-Identifier: MIT
"""The sub-step of virtual time in which everything moves."""

from __future__ import annotations

from typing import Final

STEP_MS: Final = 10
"""Length of a sub-step; every event of the robot falls on a multiple of it."""

STEP_S: Final = STEP_MS / 1000
