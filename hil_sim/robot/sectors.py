# SPDX-License-Identifier: MIT
"""The laser of a robot whose ring has one: a SIP has the nearest return in each sector of a scan of its moment."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final

from hil_sim.faults.execute import FaultSet
from hil_sim.laser.scan import Beams
from hil_sim.laser.scanner import Scanner
from hil_sim.sonar.params import Reading
from hil_sim.tables.robot import RobotTable
from hil_sim.world.model import Floats, Pose

_LEAST_MM: Final = 1


class Sectors:
    """The readings of the sectors; what is wrong with one is a fault like that of a sonar."""

    def __init__(self, table: RobotTable, scanner: Scanner, faults: FaultSet | None) -> None:
        self._table, self._scanner, self._faults = table, scanner, faults
        self._beams = Beams(table, scanner.laser.angles)

    def readings(self, now_ms: float, pose: Pose, enabled: Sequence[bool]) -> list[Reading]:
        """Return those of the arrays that are on."""
        if not any(enabled[self._table.mounts[number].array] for number in self._table.sectors):
            return []
        scan = self._scanner.scan(pose)
        found = []
        for number, mm in self._nearest(self._beams, scan).items():
            if enabled[self._table.mounts[number].array]:
                found += self._reported(number, mm, now_ms, scan)
        return found

    def _reported(self, number: int, true_mm: int, now_ms: float, scan: Floats) -> list[Reading]:
        if self._faults is None:
            return [Reading(now_ms, number, true_mm, true_mm, None)]

        def remeasure(angle_deg: float) -> int:
            turned = Beams(self._table, self._scanner.laser.angles - math.radians(angle_deg))
            return self._nearest(turned, scan).get(number, self._table.no_echo_mm)

        value, kind = self._faults.apply(number, now_ms, true_mm, remeasure)
        return [] if value is None else [Reading(now_ms, number, value, true_mm, kind)]

    def _nearest(self, beams: Beams, scan: Floats) -> dict[int, int]:
        """Return the nearest return in each sector, mm."""
        far = self._table.no_echo_mm
        return {k: far if mm >= far else max(_LEAST_MM, round(mm)) for k, mm in beams.nearest(scan).items()}
