# SPDX-License-Identifier: MIT
"""Pages that tools/gen_docs.py makes of the public header: what to do at each event, and the C functions."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Final

REMEDIES: Final = {
    "LINK_LOST": "Check cable, port and power; argusd opens the link again by itself.",
    "SESSION_NO_ANSWER": "Check that the robot is on, the port is right, and so is the rate.",
    "SUBCLASS_UNKNOWN": "Set `robot` to the body that fits, or write a table for it.",
    "ROBOT_UNSAFE": "Lower `speed_mm_s` or raise `object_range_mm` by what the value lacks.",
    "MOTORS_OFF": "Release the emergency stop, press the motor button, then order go.",
    "BUMPER": "Free the robot; it backs away by itself where it may.",
    "STALL": "Look at what holds the wheel. The place stays in the map until the mission ends.",
    "BATTERY_LOW": "Charge it.",
    "SONARS_BEYOND": "Set `robot`, or build with a larger `ARGUS_SONARS`.",
    "OTHER_ROBOT": "Make sure that it is the robot you mean; order active, then go.",
    "SONAR_DEAD": "Look whether something covers the sonar.",
    "SONAR_SILENT": "Look at its plug, and at the firing order that the robot is set to.",
    "SONAR_DISABLED": "Clean or replace it; `argusctl retest N` tries it again.",
    "SONAR_STALE": "Look at its plug.",
    "MISSION_FAILED": "The events before it say why. The course must be ordered anew.",
    "NO_WAY": "Clear the way, or order another course.",
    "WAITING": "`argusctl status` shows for what.",
    "ODOMETRY_LOST": "Set the robot where its course begins and order it anew.",
    "NO_ECHO": "Nothing, if the place is wide; else look at the array's cable.",
    "RECORD_IGNORED": "Nothing: it is written anew.",
    "EVENTS_LOST": "Read events faster; the robot was not delayed.",
    "INVARIANT": "A defect of Argus: please report it with the recording.",
    "LINK_SLOW": "Take what delays the link out of it: a radio modem, a busy host (`--realtime`).",
    "SIP_COPIED": "Nothing, if it is rare; else take out what repeats bytes: a serial server, a relay.",
    "GUARD_LOST": "Start the client again.",
}
"""What a person does, for what a person can change."""
LEVELS: Final = {
    "ERROR": "Errors",
    "WARN": "Warnings",
    "STALE": "Stale",
    "OK": "Information",
}


def catalogue(rows: Sequence[Sequence[str]]) -> str:
    """Return the events by level, each with its value and what to do."""
    lines: list[str] = []
    for level, title in LEVELS.items():
        lines += [f"## {title}", ""]
        for number, name, _, about, *meaning in (row for row in rows if row[2] == level):
            text, _, value = ", ".join(meaning).partition("; value: ")
            lines += [f"### {name}", "", f"Number {number}, about: {about}. {text[0].upper()}{text[1:]}."]
            lines += [f"Value: {value}."] if value and value != "0" else []
            lines += [f"**Do:** {REMEDIES[name]}"] if name in REMEDIES else []
            lines.append("")
    return "\n".join(lines).strip()


def _blocks(header: str) -> Iterator[tuple[list[str], str]]:
    """Yield each comment with the declaration of a function below it."""
    start = header.index("// Functions ---")
    comment: list[str] = []
    declaration: list[str] = []
    for line in header[start:].splitlines()[1:]:
        if line.startswith("// ") and not declaration:
            comment.append(line[3:])
        elif declaration or re.match(r"(static inline )?[a-z][\w ]*[ *]argus_\w+\(", line):
            declaration.append(line)
            if line.endswith((";", "{")):
                yield comment, "\n".join(declaration).removesuffix(" {") + (";" if line.endswith("{") else "")
                comment, declaration = [], []
        else:
            comment = []


def functions(header: str) -> str:
    """Return the functions, each with what stands above it in the header."""
    lines: list[str] = []
    for comment, declaration in _blocks(header):
        found = re.search(r"(argus_\w+)\(", declaration)
        assert found is not None
        lines += [f"## {found[1]}", "", "```c", declaration, "```", "", " ".join(comment), ""]
    return "\n".join(lines).strip()
