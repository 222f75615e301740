# SPDX-License-Identifier: MIT
"""All conformance checks, in the order in which they run."""

from __future__ import annotations

from typing import Final

from hil_sim.conformance import (
    drive_checks,
    packet_checks,
    safety_checks,
    session_checks,
    sip_checks,
    sonar_checks,
    turn_checks,
)
from hil_sim.conformance.check import Check

CHECKS: Final[tuple[Check, ...]] = tuple(
    check
    for module in (
        session_checks,
        sip_checks,
        packet_checks,
        sonar_checks,
        drive_checks,
        turn_checks,
        safety_checks,
    )
    for check in module.CHECKS
)
GROUPS: Final = tuple(dict.fromkeys(item.group for item in CHECKS))
