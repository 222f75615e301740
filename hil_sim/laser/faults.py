# SPDX-License-Identifier: MIT
"""What may be wrong with a laser: each takes the scans up to now, with the robot's pose, and gives the one reported."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from hil_sim.world.model import Floats

Fault = Callable[[Sequence[Floats], int], Floats | None]
"""Of scans by age, the last one now, and how many of them are since the fault began: the scan that is reported."""
BLIND_DEG: Final = 30
TURNED_DEG: Final = 10
CUT_MM: Final = 2000.0
SCALE: Final = 0.9
LATE_SCANS: Final = 10


def _dead(_scans: Sequence[Floats], _since: int) -> None:
    return None


def _dark(scans: Sequence[Floats], _since: int) -> Floats:
    return np.full_like(scans[-1], np.inf)


def _frozen(scans: Sequence[Floats], since: int) -> Floats:
    return scans[-1 - since]


def _blind(scans: Sequence[Floats], _since: int) -> Floats:
    found = scans[-1].copy()
    middle = len(found) // 2 + 20
    found[middle - BLIND_DEG // 2 : middle + BLIND_DEG // 2] = np.inf
    return found


def _turned(scans: Sequence[Floats], _since: int) -> Floats:
    return np.roll(scans[-1], TURNED_DEG)


def _scaled(scans: Sequence[Floats], _since: int) -> Floats:
    return scans[-1] * SCALE


def _late(scans: Sequence[Floats], _since: int) -> Floats:
    return scans[-1 - min(LATE_SCANS, len(scans) - 1)]


def _cut(scans: Sequence[Floats], _since: int) -> Floats:
    return np.where(scans[-1] <= CUT_MM, scans[-1], np.inf)


FAULTS: Final[dict[str, tuple[Fault, float]]] = {
    "dead": (_dead, 3.0),
    "dark": (_dark, 3.0),
    "frozen": (_frozen, 3.0),
    "blind30": (_blind, 20.0),
    "yaw10": (_turned, 60.0),
    "scale0.9": (_scaled, 60.0),
    "late1s": (_late, 20.0),
    "cut2m": (_cut, 60.0),
}
"""Each with the seconds in which it is to be found. A beam is a degree wide."""
