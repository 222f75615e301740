# SPDX-License-Identifier: MIT
"""The value of an event in words: with its unit, or as the name that it stands for."""

from __future__ import annotations

from typing import Final

from hil_sim.faults.kinds import KIND_NAME

_TABLE: Final = """<!-- values: written by tools/gen_docs.py from ARGUS_EVENT_TABLE -->
LINK_LOST ms
LINK_STALLED ms
LINK_RESUMED ms
SESSION_NO_ANSWER
SESSION_OPEN
ROBOT_UNSAFE mm
MOTORS_OFF
MOTORS_ON
BUMPER
STALL
BATTERY_LOW decivolts
SONARS_BEYOND
OTHER_ROBOT
BATTERY_ODD decivolts
SONAR_DEAD mm
SONAR_SILENT ms
SONAR_SUSPECT mm
SONAR_VERIFYING mm
SONAR_WITNESS mm
SONAR_CLEARED mm
SUSPICION_DROPPED mm
SONAR_DISABLED fault kind
SONAR_HEALTHY mm
SONAR_UNPROVEN mm
FAILURE_STATE
PLAN
PLAN_ROTATION degrees
HEALTH_CHECK
SONAR_STALE ms
SONAR_NAMED fault kind
SONAR_PROBATION mm
SONAR_KIND fault kind
SONAR_PINNED
SONAR_DEGRADING
OBJECT mm
OBJECT_CHECKED mm
AVOIDING degrees
NO_WAY seconds
STEP mm
SWEEP mm
STOPPED hundredths of a degree
BACKING mm
TURN_BLOCKED mm
WAITING seconds
MISSION_START
WAYPOINT
GOAL_REACHED mm
MISSION_FAILED mm
TURN_FAILED degrees
LOOK
POSE_LEAP mm
HEADING_LEAP degrees
SLIP mm
ODOMETRY_LOST
OPERATOR
REVERSED
INJECTED fault kind
WHEEL_SHORT
WHEEL_EVEN
CREEPING mm/s
NO_ECHO mm/s
RECORD_IGNORED
EVENTS_LOST
ORDER_UNANSWERED
SPEED_EXCEEDED mm/s
INVARIANT
LINK_SLOW ms
LINK_PROMPT ms
LASER_FAULT
SIP_COPIED
GUARD_OPEN
GUARD_CLOSED
GUARD_LOST
GUARD_DRIVES
GUARD_SLOWED mm/s
GUARD_HELD
GUARD_TURN_HELD degrees
GUARD_FREE
GUARD_REFUSED
GUARD_LOOKS degrees
GUARD_LIMITED
GUARD_DROPPED
<!-- /values -->"""
VALUES: Final = dict(line.partition(" ")[::2] for line in _TABLE.splitlines()[1:-1])
"""The unit of the value of each event that has one, in the words of the catalogue; "": a bare number."""
_NEVER: Final = 2**31 - 1
_PARTS: Final = {"hundredths of a degree": (100, "deg"), "decivolts": (10, "V")}
_UNITS: Final = {
    "degrees": "deg", "seconds": "s", "mm/s": "mm/s", "mm": "mm", "ms": "ms",
}  # fmt: skip
OPERATIONS: Final = (
    "STOP", "GO", "RECHECK", "MOVE", "TURN", "PASSIVE", "ACTIVE", "RETEST", "PIN", "UNPIN", "DISABLE",
)  # fmt: skip
KIND: Final = "fault kind"
_NAMES: Final = {0: "over"} | KIND_NAME
UNITS: Final = (*_PARTS, *_UNITS, KIND)


def value_words(event: str, value: int) -> str:
    """Return what follows the name of an event, "" where its value means nothing.

    >>> value_words("STOPPED", -9298), value_words("SONAR_SILENT", 2147483647), value_words("BATTERY_LOW", 113)
    (' -92.98 deg', ' (never)', ' 11.3 V')
    >>> value_words("SONAR_NAMED", 3), value_words("PLAN", 2), value_words("ACTIVE", 0)
    (' (stuck)', ' 2', '')
    """
    unit = VALUES.get(event)
    if unit is None:
        return ""
    if event == "OPERATOR" and 0 < value <= len(OPERATIONS):
        return f" {OPERATIONS[value - 1]}"
    if unit == KIND:
        return f" ({_NAMES.get(value, '?')})"
    if value == _NEVER and unit:
        return " (never)"
    if unit in _PARTS:
        parts, shown = _PARTS[unit]
        return f" {value / parts:.{len(str(parts)) - 1}f} {shown}"
    return f" {value} {_UNITS[unit]}" if unit else f" {value}"
