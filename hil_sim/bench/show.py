# SPDX-License-Identifier: MIT
"""The time line of one mission for people: faults, events and changes of health in the order in which they came."""

from __future__ import annotations

from collections import Counter
from typing import Any, Final

from hil_sim.sil import Collision, Event, FaultTruth, Outcome

_TRUTH, _HEALTH, _EVENT, _HIT = "FAULT", "health", "event", "HIT"
_DULL: Final = frozenset({"STEP", "SWEEP", "HEALTH_CHECK", "PLAN_ROTATION", "STATUS", "SONAR_HEALTHY"})
"""Events that come by the hundred and tell nothing of the diagnosis."""


Row = tuple[float, int, str, str]
"""When, order among those of one moment, sort, text."""


def timeline(record: dict[str, Any], outcome: Outcome) -> str:
    """Return the time line, then what the judge made of it."""
    mission = outcome.mission
    lines = [
        f"{record['id']}: world {mission.world}, seed {mission.seed}, faults {', '.join(mission.faults) or 'none'}",
        *(f"{at:9.3f} s  {what:<6}  {text}" for at, _, what, text in _rows(outcome)),
        f"{outcome.t_s:9.3f} s  end     reached: {'yes' if outcome.reached else 'no'}, {outcome.goal_mm / 1000:.2f} m "
        f"from the goal, {outcome.driven_mm / 1000:.1f} m and {outcome.driving_s:.0f} s driven, "
        f"{outcome.stops} stops, {outcome.verifications} verifications in {outcome.verifying_s:.1f} s",
    ]
    lines += _not_shown(outcome)
    lines += [_judged(fault) for fault in record["faults"]]
    lines += [
        f"judged: FALSE DISABLE of sonar {one['sonar']} at {one['t_s']:.2f} s as {one['kind']}"
        for one in record["false_disables"]
    ]
    return "\n".join(lines) + "\n"


def _rows(outcome: Outcome) -> list[Row]:
    """All that is worth a row, in the order in which it came."""
    rows = [row for truth in outcome.truth for row in _truth_rows(truth)]
    rows += _health_rows(outcome)
    rows += [(e.t_s, 2, _EVENT, _event_text(e)) for e in outcome.events if e.name not in _DULL]
    rows += [(hit.t_s, 4, _HIT, _hit_text(hit)) for hit in outcome.collisions]
    return sorted(rows)


def _not_shown(outcome: Outcome) -> list[str]:
    dull = Counter(event.name for event in outcome.events if event.name in _DULL)
    if not dull:
        return []
    return ["not shown: " + ", ".join(f"{count} {name}" for name, count in sorted(dull.items()))]


def _truth_rows(truth: FaultTruth) -> list[Row]:
    who = f"sonar {truth.sonar:2d}  {truth.text}"
    rows = [(truth.onset_s, 0, _TRUTH, f"{who}  begins, {truth.onset_driven_mm / 1000:.2f} m driven")]
    if truth.first_visible_s is not None:
        rows.append((truth.first_visible_s, 1, _TRUTH, f"{who}  first visible"))
    if truth.end_s is not None:
        rows.append((truth.end_s, 0, _TRUTH, f"{who}  ends: repaired"))
    return rows


def _event_text(event: Event) -> str:
    who = f"sonar {event.sonar:2d}  " if event.sonar is not None else ""
    return f"{who}{event.name} {event.value}  [{event.state}]"


def _hit_text(hit: Collision) -> str:
    what = "a person walked into the standing robot" if hit.struck else "collision"
    return f"{what} at {hit.x:.0f},{hit.y:.0f}"


def _judged(fault: dict[str, Any]) -> str:
    verdict = "found" if fault["found"] else "NOT FOUND in time"
    if fault["apart"]:
        verdict = f"set apart ({fault['apart']})"
    latency = "never"
    if fault["latency_s"] is not None:
        latency = f"{fault['latency_s']:.2f} s, {fault['latency_readings']} readings"
    return (
        f"judged: sonar {fault['sonar']} {fault['kind']}: {verdict}; latency {latency}; named {fault['named']}"
        f" (at its end {fault['named_end']}); {fault['visible_n']} visible readings"
        + (f"; rehabilitation: {fault['rehabilitation']}" if fault["rehabilitation"] else "")
    )


def _health_rows(outcome: Outcome) -> list[Row]:
    """One row for each moment and change, with all sonars that made it; faulty ones have an asterisk."""
    faulty = {truth.sonar for truth in outcome.truth}
    together: dict[tuple[float, str, str], list[str]] = {}
    for sonar, changes in enumerate(outcome.health):
        for change in changes:
            together.setdefault(change, []).append(f"{sonar}*" if sonar in faulty else str(sonar))
    return [
        (at, 3, _HEALTH, f"sonar {' '.join(who):<4} {health}{f' ({kind})' if kind else ''}")
        for (at, health, kind), who in together.items()
    ]
