# SPDX-License-Identifier: MIT
"""What the other sonars could tell of a faulty one: which of its readings some sonar contradicts, without a map."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Sequence
from itertools import pairwise
from typing import Final

import numpy as np
import numpy.typing as npt

from hil_sim.robot.interfaces import SonarReading
from hil_sim.sil import Sighting
from hil_sim.sil.noted import VISIBLE_MM, VISIBLE_PART
from hil_sim.sonar.params import NO_ECHO_MM, transducer_pose
from hil_sim.tables.robot import robot_table
from hil_sim.world.model import Pose

# One place and one bearing are for the observer what they are for the peers (firmware/awareness/evidence_peers.c,
# evidence_seen.c and evidence_pair.c; a test compares them).
AGE_S: Final = 40.0
BEARING_DEG: Final = 3.0
ACROSS_MM: Final = 60.0
ALONG_MM: Final = 200.0
NEAREST_MM: Final = 150.0
FARTHEST_MM: Final = 4600.0
AGREE_MM: Final = 80.0
AGREE_PART: Final = 0.05

_LISTED_S: Final = 0.5
_T, _X, _Y, _BEARING, _RANGE = range(5)
Table = npt.NDArray[np.float64]


def is_visible(reading: SonarReading) -> bool:
    """Whether a reading is off by more than max(100 mm, 5 %)."""
    return abs(reading.range_mm - reading.true_mm) > max(VISIBLE_MM, VISIBLE_PART * reading.true_mm)


def fired(sightings: Sequence[Sighting], sonar: int, begin_s: float, end_s: float) -> int:
    """Return how many readings a sonar gave from begin to end."""
    return sum(
        reading.number == sonar and begin_s <= reading.t_ms / 1000 <= end_s
        for sighting in _seen(sightings, begin_s, end_s)
        for reading in sighting.readings
    )


def contradicted(sightings: Sequence[Sighting], sonar: int, begin_s: float, end_s: float) -> int:
    """Return how many visible readings of a faulty sonar, begin to end, a sound reading of another contradicts.

    Both from one place on one bearing, at most 40 s apart, in whichever order, and both made by `end_s`. `sightings`:
    of the whole mission in order of time. Cost: the product of both counts, about 100 by 3,500 for 30 s.
    """
    own, others = _pings(_seen(sightings, begin_s - AGE_S, end_s), sonar)
    own = own[(own[:, _T] >= begin_s) & (own[:, _T] <= end_s)]
    others = others[others[:, _T] <= end_s]
    return sum(bool(_contradicts(ping, others).any()) for ping in own)


def _seen(sightings: Sequence[Sighting], begin_s: float, end_s: float) -> Sequence[Sighting]:
    """Those that may list what was made from begin to end. A SIP comes up to half a second after it, and the last
    one before shows where the robot was."""
    times = [one.t_s for one in sightings]
    first = bisect_left(times, begin_s)
    return sightings[max(0, first - 1) : bisect_right(times, end_s + _LISTED_S)]


def _pings(sightings: Sequence[Sighting], sonar: int) -> tuple[Table, Table]:
    """The visible readings of a faulty sonar, and the sound ones of the others: time, place, bearing, range."""
    own, others = [], []
    for before, now in pairwise(sightings):
        for reading in now.readings:
            if reading.number == sonar:
                if reading.fault is not None and is_visible(reading):
                    own.append(_ping(reading, before, now))
            elif reading.fault is None:
                others.append(_ping(reading, before, now))
    return np.array(own).reshape(-1, 5), np.array(others).reshape(-1, 5)


def _ping(reading: SonarReading, before: Sighting, now: Sighting) -> tuple[float, ...]:
    at = transducer_pose(robot_table().mounts[reading.number], _between(before, now, reading.t_ms / 1000))
    return reading.t_ms / 1000, at.x_mm, at.y_mm, at.heading_deg, reading.range_mm


def _between(before: Sighting, now: Sighting, t_s: float) -> Pose:
    """The pose at a moment between two SIPs, or about them."""
    span = now.t_s - before.t_s
    part = min(1.0, max(0.0, (t_s - before.t_s) / span)) if span > 0 else 1.0
    turn = (now.pose.heading_deg - before.pose.heading_deg + 180) % 360 - 180
    return Pose(
        before.pose.x_mm + part * (now.pose.x_mm - before.pose.x_mm),
        before.pose.y_mm + part * (now.pose.y_mm - before.pose.y_mm),
        before.pose.heading_deg + part * turn,
    )


def _contradicts(own: Table, others: Table) -> npt.NDArray[np.bool_]:
    """Which of the others saw something else than one ping says, from its place and on its bearing."""
    bearing = math.radians(own[_BEARING])
    dx, dy = own[_X] - others[:, _X], own[_Y] - others[:, _Y]
    along = dx * math.cos(bearing) + dy * math.sin(bearing)
    across = np.abs(dy * math.cos(bearing) - dx * math.sin(bearing))
    turned = np.abs((own[_BEARING] - others[:, _BEARING] + 180) % 360 - 180)
    same = (np.abs(own[_T] - others[:, _T]) <= AGE_S) & (turned <= BEARING_DEG)
    same &= (across <= ACROSS_MM) & (np.abs(along) <= ALONG_MM)
    none, was_none = own[_RANGE] >= NO_ECHO_MM, others[:, _RANGE] >= NO_ECHO_MM
    here = np.where(was_none, own[_RANGE] + along, others[:, _RANGE] - along)
    limit = AGREE_MM + AGREE_PART * np.minimum(here, own[_RANGE])
    one_misses = (none != was_none) & (here <= FARTHEST_MM)
    differ = ~none & ~was_none & (np.abs(here - own[_RANGE]) > limit)
    return np.asarray(same & (here >= NEAREST_MM) & (one_misses | differ))
