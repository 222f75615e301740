# SPDX-License-Identifier: MIT
"""What argusd says on its control socket, in words for people."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from hil_sim.faults.values import value_words

_LEVELS: Final = ("OK", "WARN", "ERROR", "STALE")
_MARKS: Final = {"DISABLED": "!", "PROBATION": "!", "SUSPECT": "?", "ABSENT": "-", "STALE": "~"}


def event_line(event: dict[str, Any]) -> str:
    """Return an event as one line.

    >>> event_line({"t": 7.5, "event": "INJECTED", "level": 1, "name": "sonar/front/03", "value": 3})
    '    7.500 WARN  sonar/front/03 INJECTED (stuck)'
    """
    level = _LEVELS[event["level"]] if event["level"] < len(_LEVELS) else "?"
    words = value_words(event["event"], event["value"])
    return f"{event['t']:9.3f} {level:<5} {event['name']:<14} {event['event']}{words}"


def readings_line(readings: dict[str, Any]) -> str:
    """Return the readings of one packet as one line.

    >>> readings_line({"t": 1.0, "sip": 9, "mm": [500, 5000], "age_ms": [0, -1]})
    '    1.000 sip 9: 500 -'
    """
    pairs = zip(readings["mm"], readings["age_ms"], strict=True)
    values = " ".join(str(mm) if age >= 0 else "-" for mm, age in pairs)
    return f"{readings['t']:9.3f} sip {readings['sip']}: {values}"


def evidence_line(evidence: dict[str, Any]) -> str:
    """Return what the evidence is so far as one line.

    >>> evidence_line({"t": 5.0, "kind": ["", "stuck"], "level": [0, 60], "seen_by": [[], [0]]})
    '    5.000 sonar 1: stuck 60 %, contradicted by 0'
    >>> evidence_line({"t": 5.0, "kind": [""], "level": [0], "seen_by": [[]]})
    '    5.000 no evidence against any sonar'
    """
    parts = []
    for k, (kind, level, voices) in enumerate(
        zip(evidence["kind"], evidence["level"], evidence["seen_by"], strict=True)
    ):
        if level > 0:
            by = f", contradicted by {' '.join(map(str, voices))}" if voices else ""
            parts.append(f"sonar {k}: {kind} {level} %{by}")
    return f"{evidence['t']:9.3f} {'; '.join(parts) or 'no evidence against any sonar'}"


def _sonars(state: dict[str, Any], numbers: Sequence[int]) -> str:
    cells = []
    for k in numbers:
        mark = "*" if state["injected"][k] else _MARKS.get(state["health"][k], " ")
        reading = state["reading_mm"][k] if state["age_ms"][k] >= 0 else "-"
        cells.append(f"{reading:>5}{mark}")
    return "".join(cells)


def _notes(state: dict[str, Any]) -> list[str]:
    lines = []
    for k, (health, kind) in enumerate(zip(state["health"], state["kind"], strict=True)):
        if kind:
            lines.append(f"sonar {k}: {health}, {kind}")
    for k, kind in enumerate(state["injected"]):
        if kind:
            lines.append(f"sonar {k}: INJECTED, argusd itself makes it {kind}")
    return lines


def status_text(state: dict[str, Any]) -> str:
    """Return a state as some lines."""
    if not state["online"]:
        where = f"no robot on {state['link']}" if state["link"] else "no link"
        return f"{state['t']:9.3f} {state['mode']}, {where}"
    doing = "active" if state["active"] else "passive"
    doing += ", paused" if state["paused"] else ""
    doing += ", somebody has control" if state["controlled"] else ""
    lines = [
        f"{state['t']:9.3f} {state['mode']} {state['state']}, {doing}",
        f"  {state['robot']} ({state['subclass']}) at {state['x_mm']},{state['y_mm']} mm, "
        f"{state['heading_cdeg'] / 100:.0f} deg, {state['battery_dv'] / 10:.1f} V",
    ]
    if state["waypoints"]:
        lines.append(
            f"  mission {state['mission']}, {state['goal_mm']} mm from the goal, "
            f"waypoint {state['waypoint']} of {state['waypoints']}"
        )
    lines.append(f"  front {_sonars(state, range(8))}")
    lines.append(f"  rear  {_sonars(state, range(8, len(state['reading_mm'])))}")
    lines += [f"  {note}" for note in _notes(state)]
    return "\n".join(lines)
