# SPDX-License-Identifier: MIT
"""The judge of one bench mission: what was found, when, what it was called, and what was wrongly given up."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any, Final

import numpy as np

from hil_sim.bench.witness import Pings
from hil_sim.sil import Collision, FaultTruth, Outcome, Seen
from hil_sim.sonar.params import NO_ECHO_MM
from hil_sim.tables.robot import robot_table

RECORD_FORMAT: Final = 4
"""Raised whenever a record gets another field: results of two formats do not mix."""
BOUND_S: Final[Mapping[str, float]] = {
    "off": 10.0,
    "silent": 30.0,
    "stuck": 30.0,
    "wrong": 30.0,
    "garbage": 10.0,
    "slow": 10.0,
    "intermittent": 30.0,
}
"""Within this time from the first visible reading a fault must be found: the p99 bounds."""
SHOWN_READINGS: Final = 3
"""A fault with fewer visible readings in its whole life could not show: one or two look like crosstalk.

A sonar that is DISABLED fires no more, so the rule sets none apart that was DISABLED while it failed.
"""
NOTED_READINGS: Final = 16
"""Of so many of its first visible readings a record tells the times."""
REFRESH_S: Final = robot_table().refresh_ms / 1000
"""Each sonar of the two arrays of eight fires once in this time."""
FALSE_AFTER_S: Final = 10.0
"""A sonar DISABLED this long after its fault has ended is a false disable."""
REPAIRED_DRIVING_S: Final = 60.0
DISABLED: Final = "DISABLED"
SUSPECT: Final = "SUSPECT"
HEALTHY: Final = "HEALTHY"
_ANY_NAME: Final = tuple(BOUND_S)
_SAYS_NOTHING: Final = (HEALTHY, "UNKNOWN")
_MOVING_MM_S: Final = 5.0
_TURNING_DEG_S: Final = 1.0

Change = tuple[float, str, str]


@dataclass
class Track:
    """What the judge knows of each SIP: way and driving time, what faulty sonars report, and all that was seen."""

    t_s: list[float]
    driven_mm: list[float]
    driving_s: list[float]
    visible_s: dict[int, list[float]]
    stuck_mm: dict[int, set[int]] = field(default_factory=dict)
    pings: Pings = field(default_factory=Pings)

    @classmethod
    def of(cls, seen: Seen) -> Track:
        """Return what is known once a mission is over."""
        rows, pings = seen.rows, Pings.of(seen)
        t_s = rows["t_ms"] / 1000
        moves = (abs(rows["v"]) > _MOVING_MM_S) | (abs(rows["w"]) > _TURNING_DEG_S)
        driving_s = np.cumsum(np.where(moves, np.diff(t_s, prepend=t_s[:1]), 0.0))
        shown = pings.readings[pings.is_visible()]
        stuck = pings.readings[pings.of_kind("stuck")]
        return cls(
            t_s.tolist(),
            rows["travelled_mm"].tolist(),
            driving_s.tolist(),
            {
                int(n): (shown["t_ms"][shown["number"] == n] / 1000).tolist()
                for n in set(shown["number"].tolist())
            },
            {
                int(n): set(stuck["range_mm"][stuck["number"] == n].tolist())
                for n in set(stuck["number"].tolist())
            },
            pings,
        )

    def driving_at(self, t_s: float) -> float:
        """Return the time in motion up to a moment."""
        return self._at(self.driving_s, t_s)

    def driven_at(self, t_s: float) -> float:
        """Return the way driven up to a moment."""
        return self._at(self.driven_mm, t_s)

    def _at(self, values: Sequence[float], t_s: float) -> float:
        place = bisect_right(self.t_s, t_s)
        return values[place - 1] if place else 0.0


def health_at(changes: Sequence[Change], t_s: float) -> tuple[str, str]:
    """Return health and kind of a sonar at a moment."""
    now = ("UNKNOWN", "")
    for at, health, kind in changes:
        if at > t_s:
            break
        now = (health, kind)
    return now


def right_names(truth: FaultTruth, track: Track) -> tuple[str, ...]:
    """Return the kinds that name a fault rightly: its own, and `off` for one stuck at the value of no echo.

    On the wire the two are the same: 5000 in each slot.
    """
    if truth.kind == "stuck" and track.stuck_mm.get(truth.sonar) == {NO_ECHO_MM}:
        return truth.kind, "off"
    return (truth.kind,)


def detection(
    changes: Sequence[Change], kinds: Sequence[str], begin_s: float, end_s: float
) -> tuple[float, str, str] | None:
    """Return when a sonar was first DISABLED, or named by one of the kinds, from begin to end; health and kind then.

    A sonar that was DISABLED before it failed says nothing about the fault; the judge sets such cases apart.
    """
    for at, health, named in changes:
        if begin_s <= at <= end_s and (
            health == DISABLED or (named in kinds and health not in _SAYS_NOTHING)
        ):
            return at, health, named
    return None


def judge_fault(truth: FaultTruth, outcome: Outcome, track: Track) -> dict[str, Any]:
    """Return the record of one injected fault."""
    changes = outcome.health[truth.sonar]
    end_s = truth.end_s if truth.end_s is not None else outcome.t_s
    record: dict[str, Any] = {
        "kind": truth.kind,
        "sonar": truth.sonar,
        "text": truth.text,
        "onset_s": _r(truth.onset_s),
        "end_s": _r(truth.end_s),
        "visible_s": _r(truth.first_visible_s),
        "visible_n": _visible_count(truth, track, end_s),
        "visible_in_time": _visible_in_time(truth, track, end_s),
        "visible_at": _visible_at(truth, track, end_s),
        "readings_in_time": _readings_in_time(truth, track, end_s),
        "contradicted_in_time": _contradicted_in_time(truth, track, end_s),
        "apart": None,
        "found": False,
        "doubted_s": None,
        "named": None,
        "named_right": None,
        "named_end": None,
        "named_end_right": None,
        "latency_s": None,
        "latency_mm": None,
        "latency_readings": None,
        "rehabilitated_s": None,
        "rehabilitation": None,
    }
    kinds = right_names(truth, track)
    found = detection(changes, kinds, truth.onset_s, end_s)
    record["apart"] = _apart(truth, changes, end_s, found is None and record["visible_n"] < SHOWN_READINGS)
    doubted = detection(changes, _ANY_NAME, truth.onset_s, end_s)
    if doubted is not None and truth.first_visible_s is not None:
        record["doubted_s"] = _r(max(0.0, doubted[0] - truth.first_visible_s))
    if found is not None:
        at, _, named = found
        record |= _latency(truth, track, at)
        record["named"] = named or "none"
        record["named_right"] = named in kinds
        record["named_end"] = _kind_at_end(changes, truth.onset_s, end_s) or "none"
        record["named_end_right"] = record["named_end"] in kinds
    _judge_repair(record, truth, outcome, track)
    return record


def _apart(truth: FaultTruth, changes: Sequence[Change], end_s: float, hardly_shown: bool) -> str | None:
    """Why a case says nothing about the diagnosis; None when it does."""
    if health_at(changes, truth.onset_s)[0] == DISABLED:
        return "disabled before"
    if truth.first_visible_s is None or hardly_shown:
        return "not shown"
    return "ended early" if end_s - truth.first_visible_s < BOUND_S[truth.kind] else None


def _latency(truth: FaultTruth, track: Track, at: float) -> dict[str, Any]:
    """How long it took until a fault was found at `at`, and whether that was in time."""
    since = truth.first_visible_s if truth.first_visible_s is not None else at
    took_s = round(max(0.0, at - since), 3)
    seen = track.visible_s.get(truth.sonar, [])
    return {
        "latency_s": took_s,
        "latency_mm": _r(max(0.0, track.driven_at(at) - track.driven_at(since))),
        "latency_readings": bisect_right(seen, at) - bisect_right(seen, truth.onset_s),
        "found": took_s <= BOUND_S[truth.kind],
    }


def _in_time(truth: FaultTruth, end_s: float) -> tuple[float, float]:
    """From the first visible reading on, the time to find a fault."""
    first_s = truth.first_visible_s if truth.first_visible_s is not None else end_s
    return first_s, min(end_s, first_s + BOUND_S[truth.kind])


def _visible_in_time(truth: FaultTruth, track: Track, end_s: float) -> int:
    """The visible readings while there is time to find the fault: there is no more to find it by."""
    if truth.first_visible_s is None:
        return 0
    return _visible_count(truth, track, _in_time(truth, end_s)[1])


def _visible_at(truth: FaultTruth, track: Track, end_s: float) -> list[float]:
    """When the first visible readings came, s after the first: as many as an observer of the truth may want."""
    first_s = truth.first_visible_s
    if first_s is None:
        return []
    if truth.kind == "silent":
        return [
            round(k * REFRESH_S, 3) for k in range(min(NOTED_READINGS, _visible_count(truth, track, end_s)))
        ]
    seen = [t for t in track.visible_s.get(truth.sonar, []) if first_s <= t <= end_s]
    return [round(t - first_s, 3) for t in seen[:NOTED_READINGS]]


def _readings_in_time(truth: FaultTruth, track: Track, end_s: float) -> int:
    """All that the sonar reported in that time, right or not; of one that is silent its slots."""
    if truth.kind == "silent":
        return _visible_in_time(truth, track, end_s)
    return track.pings.fired(truth.sonar, *_in_time(truth, end_s))


def _contradicted_in_time(truth: FaultTruth, track: Track, end_s: float) -> int:
    """Of the visible readings in that time, those that another sonar contradicts; a missing one needs none."""
    if truth.kind == "silent":
        return _visible_in_time(truth, track, end_s)
    return track.pings.contradicted(truth.sonar, *_in_time(truth, end_s))


def _visible_count(truth: FaultTruth, track: Track, end_s: float) -> int:
    if truth.kind == "silent":
        # A missing reading is in no SIP; each slot from the first one on is one.
        return 0 if truth.first_visible_s is None else 1 + int((end_s - truth.first_visible_s) / REFRESH_S)
    seen = track.visible_s.get(truth.sonar, [])
    return bisect_right(seen, end_s) - bisect_right(seen, truth.onset_s)


def _kind_at_end(changes: Sequence[Change], onset_s: float, end_s: float) -> str:
    """The kind of the last state while the fault was there that is DISABLED, or another that counts as named."""
    kinds = [
        kind
        for at, health, kind in changes
        if onset_s <= at <= end_s and (health == DISABLED or (kind and health not in _SAYS_NOTHING))
    ]
    return kinds[-1] if kinds else ""


def _judge_repair(record: dict[str, Any], truth: FaultTruth, outcome: Outcome, track: Track) -> None:
    """Whether a sonar that was not HEALTHY when its fault ended came back within 60 s of driving."""
    changes = outcome.health[truth.sonar]
    if truth.end_s is None or record["apart"] == "disabled before" or not _was_disabled(truth, changes):
        return
    start = track.driving_at(truth.end_s)
    back = next((at for at, health, _ in changes if at > truth.end_s and health == HEALTHY), None)
    if back is not None:
        took = track.driving_at(back) - start
        record["rehabilitated_s"] = _r(took)
        record["rehabilitation"] = "back" if took <= REPAIRED_DRIVING_S else "late"
    elif track.driving_at(outcome.t_s) - start < REPAIRED_DRIVING_S:
        record["rehabilitation"] = "ended early"
    else:
        record["rehabilitation"] = "never"


def _was_disabled(truth: FaultTruth, changes: Sequence[Change]) -> bool:
    """Whether a sonar was DISABLED while its fault was there, and not HEALTHY at its end."""
    assert truth.end_s is not None
    during = [health for at, health, _ in changes if truth.onset_s <= at <= truth.end_s]
    return DISABLED in during and health_at(changes, truth.end_s)[0] != HEALTHY


def false_disables(outcome: Outcome) -> list[dict[str, Any]]:
    """Return each entry of a sonar into DISABLED with no fault of it active in the last 10 s."""
    return [
        {"t_s": _r(at), "sonar": sonar, "kind": kind or "none"}
        for sonar, before, (at, health, kind) in _without_fault(outcome)
        if health == DISABLED and before[1] != DISABLED
    ]


def false_names(outcome: Outcome) -> list[dict[str, Any]]:
    """Return each time that a SUSPECT was given a kind with no fault of it active in the last 10 s.

    No robot acts on it as on a false disable, but a name is what the definition of found accepts.
    """
    return [
        {"t_s": _r(at), "sonar": sonar, "kind": kind}
        for sonar, before, (at, health, kind) in _without_fault(outcome)
        if health == SUSPECT and kind and before[1:] != (SUSPECT, kind)
    ]


def _without_fault(outcome: Outcome) -> Iterator[tuple[int, Change, Change]]:
    """Each change of a sonar with no fault of it active in the last 10 s, and the state before it."""
    for sonar, changes in enumerate(outcome.health):
        spans = [
            (truth.onset_s, (truth.end_s if truth.end_s is not None else outcome.t_s) + FALSE_AFTER_S)
            for truth in outcome.truth
            if truth.sonar == sonar
        ]
        for before, now in pairwise([(0.0, "UNKNOWN", ""), *changes]):
            if not any(begin <= now[0] <= end for begin, end in spans):
                yield sonar, before, now


def judge(outcome: Outcome, track: Track, twin: Outcome | None) -> dict[str, Any]:
    """Return the record of a mission; `twin`: the same mission without faults, where a collision asked for it."""
    faults = [judge_fault(truth, outcome, track) for truth in outcome.truth]
    hits = _driven_into(outcome)
    twin_hits = hits if twin is None else _driven_into(twin)
    attributable = bool(hits) and bool(outcome.truth) and not twin_hits
    return {
        "t_s": _r(outcome.t_s),
        "driving_s": _r(outcome.driving_s),
        "driven_mm": _r(outcome.driven_mm),
        "reached": outcome.reached,
        "goal_mm": _r(outcome.goal_mm),
        "faults": faults,
        "false_disables": false_disables(outcome),
        "false_names": false_names(outcome),
        "collisions": [[_r(hit.t_s), _r(hit.x), _r(hit.y)] for hit in hits],
        "struck": len(outcome.collisions) - len(hits),
        "attributable": attributable,
        "undetected": attributable and _undetected(outcome, hits[0].t_s),
        "stops": outcome.stops,
        "verifications": outcome.verifications,
        "verifying_s": _r(outcome.verifying_s),
        "digest": outcome.digest,
    }


def _driven_into(outcome: Outcome) -> list[Collision]:
    return [hit for hit in outcome.collisions if not hit.struck]


def _undetected(outcome: Outcome, t_s: float) -> bool:
    """Whether a fault was there at a moment that had not been found."""
    return any(
        truth.onset_s <= t_s
        and (truth.end_s is None or t_s < truth.end_s)
        and health_at(outcome.health[truth.sonar], t_s)[0] != DISABLED
        for truth in outcome.truth
    )


def _r(value: float | None) -> float | None:
    return None if value is None else round(value, 3)
