# SPDX-License-Identifier: MIT
"""What is published of a reading: as it is, after REP 117, withheld, as NaN, or covered by its neighbours."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Final

from argus_tools.rings.intake import Limits

from hil_sim.tables.robot import RobotTable

COVER_DEG: Final = 45.0
"""A neighbour stands in for a sonar whose bearing is at most this far from its own."""


class Dead(Enum):
    """What becomes of a reading that is not to be trusted; `nan` would be read as a number on a command line."""

    WITHHOLD = "withhold"
    INVALID = "invalid"
    COVER = "cover"


class NoEcho(Enum):
    """What stands for "nothing seen": +inf as REP 117 says, or the greatest range."""

    REP117 = "rep117"
    MAX = "max"


class Trust(Enum):
    """Which sonars are trusted: all but those with the name of a fault, or healthy ones only."""

    NAMED = "named"
    HEALTHY = "healthy"


@dataclass(frozen=True)
class Verdict:
    """What the fault manager says of a sonar: its health, and the name of its fault (empty: none)."""

    health: str = "UNKNOWN"
    kind: str = ""

    def trusted(self, trust: Trust) -> bool:
        """Whether its readings may be used."""
        return not self.kind if trust is Trust.NAMED else self.health == "HEALTHY" and not self.kind


@dataclass(frozen=True)
class Policy:
    """How readings are repaired."""

    dead: Dead = Dead.WITHHOLD
    no_echo: NoEcho = NoEcho.REP117
    trust: Trust = Trust.NAMED

    def good(self, range_m: float, limits: Limits) -> float:
        """Return what is published for a trusted reading."""
        if math.isnan(range_m):
            return range_m
        if range_m >= limits.greatest_m:
            return math.inf if self.no_echo is NoEcho.REP117 else limits.greatest_m
        return range_m if range_m >= limits.least_m else -math.inf

    def bad(self, covering_m: Sequence[float], limits: Limits) -> float | None:
        """Return what is published for a reading not to be trusted; None: nothing.

        covering_m: the last readings of those that stand in for it. The nearest echo counts; without one of them
        nothing is known there, and nothing is said.
        """
        if self.dead is Dead.INVALID:
            return math.nan
        if self.dead is Dead.WITHHOLD or not covering_m:
            return None
        return self.good(min(covering_m), limits)


def bearings(table: RobotTable) -> dict[int, float]:
    """Return where each sonar of a robot looks, degrees."""
    return {number: mount.heading_deg for number, mount in enumerate(table.mounts)}


def neighbours(of: int, bearing_deg: Mapping[int, float]) -> list[int]:
    """Return the sonars that stand in for one: on either side the next, if it looks nearly the same way.

    >>> neighbours(3, {2: 30.0, 3: 10.0, 4: -10.0, 5: -30.0})
    [2, 4]
    """
    found = []
    for side in (1.0, -1.0):
        away = {
            number: turn
            for number, deg in bearing_deg.items()
            if number != of and 0 < (turn := (side * (deg - bearing_deg[of])) % 360) <= COVER_DEG
        }
        if away:
            found.append(min(away, key=lambda number: away[number]))
    return sorted(found)
