# SPDX-License-Identifier: MIT
"""The judge of one drive-by: what a manager that only listens found, when, and what it said wrongly."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from hil_sim.bench.judge import BOUND_S, DISABLED, FALSE_AFTER_S, SHOWN_READINGS, SUSPECT
from hil_sim.bench.stream import Stream
from hil_sim.core.replay import Change, Engine
from hil_sim.sil import FaultTruth
from hil_sim.sil.noted import VISIBLE_MM, VISIBLE_PART
from hil_sim.sonar.params import NO_ECHO_MM

SETTINGS: Final[Mapping[str, int]] = {"active": 0, "profile": 1}
"""active = off, profile = argus."""
_NUMBER, _RANGE, _TRUE, _FAULTY, _FIRED = range(5)


@dataclass(frozen=True)
class Finding:
    """What became of one injected fault. latency_s: from its first visible reading; None: never found."""

    kind: str
    place: str
    latency_s: float | None
    named: str
    named_right: bool

    @property
    def in_time(self) -> bool:
        """It was found within the bound of its kind."""
        return self.latency_s is not None and self.latency_s <= BOUND_S[self.kind]


@dataclass
class Verdict:
    """What came of one stream. hours: by the clock. names, disables: of healthy sonars, as times, sonar and kind."""

    id: str
    people: bool
    hours: float
    findings: list[Finding] = field(default_factory=list)
    names: list[tuple[float, int, str]] = field(default_factory=list)
    disables: list[tuple[float, int, str]] = field(default_factory=list)


def judge_stream(stream: Stream, engine: Engine) -> Verdict:
    """Replay a stream through a manager and judge what it says."""
    changes = engine.replay(stream.times_ms.tobytes(), stream.lengths.tobytes(), stream.data, SETTINGS)
    return judge_changes(stream, changes)


def judge_changes(stream: Stream, changes: Sequence[Change]) -> Verdict:
    """Judge the changes of health that a manager made of a stream."""
    verdict = Verdict(stream.id, stream.people, stream.end_s / 3600)
    for truth in stream.truth:
        finding = _finding(stream, truth, [change for change in changes if change.sonar == truth.sonar])
        if finding is not None:
            verdict.findings.append(finding)
    _count_false(stream, changes, verdict)
    return verdict


def _end_s(stream: Stream, truth: FaultTruth) -> float:
    return truth.end_s if truth.end_s is not None else stream.end_s


def _finding(stream: Stream, truth: FaultTruth, changes: Sequence[Change]) -> Finding | None:
    """None: it could not have been found, since it did not show, or not for as long as its bound."""
    first, end_s = truth.first_visible_s, _end_s(stream, truth)
    rows = stream.readings
    fired_s = rows[:, _FIRED] / 1000
    live = rows[(rows[:, _NUMBER] == truth.sonar) & (fired_s >= truth.onset_s) & (fired_s <= end_s)]
    faulty = live[live[:, _FAULTY] == 1]
    right = {truth.kind}
    if truth.kind == "stuck" and set(faulty[:, _RANGE].tolist()) == {NO_ECHO_MM}:
        right.add("off")  # on the wire the two are the same
    found = _detection(changes, right, truth.onset_s, end_s)
    limit = np.maximum(VISIBLE_MM, VISIBLE_PART * faulty[:, _TRUE])
    shown = int((np.abs(faulty[:, _RANGE] - faulty[:, _TRUE]) > limit).sum())
    hidden = truth.kind != "silent" and found is None and shown < SHOWN_READINGS
    if first is None or hidden or end_s - first < BOUND_S[truth.kind]:
        return None
    latency_s = max(0.0, found.t_s - first) if found is not None else None
    named = found.kind if found is not None else ""
    return Finding(truth.kind, stream.place, latency_s, named, named in right)


def _detection(changes: Sequence[Change], right: set[str], begin_s: float, end_s: float) -> Change | None:
    for change in changes:
        told = change.health == DISABLED or (change.health == SUSPECT and change.kind in right)
        if told and begin_s <= change.t_s <= end_s:
            return change
    return None


def _count_false(stream: Stream, changes: Sequence[Change], verdict: Verdict) -> None:
    spans = [(t.sonar, t.onset_s, _end_s(stream, t) + FALSE_AFTER_S) for t in stream.truth]
    before: dict[int, tuple[str, str]] = {}
    for t_s, sonar, health, kind in changes:
        was = before.get(sonar, ("", ""))
        before[sonar] = health, kind
        if _is_within(spans, sonar, t_s):
            continue
        if health == DISABLED and was[0] != DISABLED:
            verdict.disables.append((t_s, sonar, kind))
        if health == SUSPECT and kind and (health, kind) != was:
            verdict.names.append((t_s, sonar, kind))


def _is_within(spans: Sequence[tuple[int, float, float]], sonar: int, t_s: float) -> bool:
    return any(sonar == of and begin <= t_s <= end for of, begin, end in spans)
