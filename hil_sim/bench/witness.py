# SPDX-License-Identifier: MIT
"""What the other sonars could tell of a faulty one: which of its readings some sonar contradicts, without a map."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final

import numpy as np
import numpy.typing as npt

from hil_sim.sil import READING, Seen
from hil_sim.sil.noted import VISIBLE_MM, VISIBLE_PART
from hil_sim.sonar.params import NO_ECHO_MM
from hil_sim.tables.robot import robot_table
from hil_sim.world.model import Floats

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
Flags = npt.NDArray[np.bool_]


@dataclass(frozen=True)
class Pings:
    """All readings of a mission with the SIPs that list them.

    t_s, places: of each SIP, in order of time: when it was made, and where the robot was (x, y in mm, degrees), (n, 3).
    readings: of the type `hil_sim.sil.READING`. row: of each reading the SIP that lists it. kinds: of faults, by their
    number.
    """

    t_s: Floats = field(default_factory=lambda: np.zeros(0))
    places: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    readings: npt.NDArray[np.void] = field(default_factory=lambda: np.zeros(0, READING))
    row: npt.NDArray[np.intp] = field(default_factory=lambda: np.zeros(0, np.intp))
    kinds: tuple[str | None, ...] = (None,)

    @classmethod
    def of(cls, seen: Seen) -> Pings:
        """Return those of what was seen."""
        rows = seen.rows
        row, readings = seen.listed()
        places = np.stack([rows["x"], rows["y"], rows["heading"]], axis=-1)
        return cls(rows["t_ms"] / 1000, places, readings, row, seen.kinds)

    def is_visible(self) -> Flags:
        """Which readings are a fault's and off by more than max(100 mm, 5 %)."""
        off = abs(self.readings["range_mm"] - self.readings["true_mm"])
        limit = np.maximum(VISIBLE_MM, VISIBLE_PART * self.readings["true_mm"])
        return np.asarray((self.readings["kind"] > 0) & (off > limit))

    def of_kind(self, kind: str) -> Flags:
        """Which readings are of a kind of fault."""
        number = self.kinds.index(kind) if kind in self.kinds else -1
        return np.asarray(self.readings["kind"] == number)

    def fired(self, sonar: int, begin_s: float, end_s: float) -> int:
        """Return how many readings a sonar gave from begin to end."""
        first, last = self._listing(begin_s, end_s)
        t_s = self.readings["t_ms"] / 1000
        own = (self.readings["number"] == sonar) & (begin_s <= t_s) & (t_s <= end_s)
        return int(np.count_nonzero(own & (first <= self.row) & (self.row < last)))

    def contradicted(self, sonar: int, begin_s: float, end_s: float) -> int:
        """Return how many visible readings of a faulty sonar, begin to end, a sound reading of another contradicts.

        Both from one place on one bearing, at most 40 s apart, in whichever order, and both made by `end_s`. Cost: the
        product of both counts, about 100 by 3,500 for 30 s.
        """
        first, last = self._listing(begin_s - AGE_S, end_s)
        t_s = self.readings["t_ms"] / 1000
        here = (first < self.row) & (self.row < last) & (t_s <= end_s)
        is_own = self.readings["number"] == sonar
        own = self._made(here & is_own & self.is_visible() & (t_s >= begin_s))
        others = self._made(here & ~is_own & (self.readings["kind"] == 0))
        return sum(bool(_contradicts(ping, others).any()) for ping in own)

    def _listing(self, begin_s: float, end_s: float) -> tuple[int, int]:
        """The SIPs that may list what was made from begin to end. One comes up to half a second after it, and the
        last one before shows where the robot was."""
        first = int(np.searchsorted(self.t_s, begin_s, "left"))
        return max(0, first - 1), int(np.searchsorted(self.t_s, end_s + _LISTED_S, "right"))

    def _made(self, which: Flags) -> Floats:
        """Of readings that another SIP came before: time, place of the sonar, bearing, range."""
        readings, row = self.readings[which], self.row[which]
        t_s = readings["t_ms"] / 1000
        x, y, heading = self._places_at(row, t_s)
        mounts = np.array([(m.x_mm, m.y_mm, m.heading_deg) for m in robot_table().mounts])[readings["number"]]
        c, s = np.cos(np.radians(heading)), np.sin(np.radians(heading))
        mount_x, mount_y, mount_deg = mounts.reshape(-1, 3).T
        at_x, at_y = x + mount_x * c - mount_y * s, y + mount_x * s + mount_y * c
        return np.stack([t_s, at_x, at_y, heading + mount_deg, readings["range_mm"]], axis=-1)

    def _places_at(self, row: npt.NDArray[np.intp], t_s: Floats) -> Floats:
        """Where the robot was at moments between a SIP and the one before, or about them: x, y, heading."""
        before, now = self.places[row - 1], self.places[row]
        span = self.t_s[row] - self.t_s[row - 1]
        passed = np.clip((t_s - self.t_s[row - 1]) / np.where(span > 0, span, 1.0), 0.0, 1.0)
        way = now - before
        way[:, 2] = (way[:, 2] + 180) % 360 - 180
        return (before + np.where(span > 0, passed, 1.0)[:, np.newaxis] * way).T


def _contradicts(own: Floats, others: Floats) -> Flags:
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
