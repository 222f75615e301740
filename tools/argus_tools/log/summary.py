# SPDX-License-Identifier: MIT
"""What remains of all that the fault manager said of a log: a few lines for people, one if nothing is wrong."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any, Final

from argus_tools.log.packets import Row
from hil_sim.arcos import TIMING
from hil_sim.core.library import CoreEvent, kind_name

# A suspicion that is younger may go with the next SIP.
LASTING_S: Final = 5.0
# Sonars fail one by one. When more than these are suspects at once, it is the place or the motion that misleads.
SUSPECTS_MAX: Final = 4
SUSPECT, DISABLED = "SUSPECT", "DISABLED"
_ELSE: Final = {"STALE": "yields no reading any more", "PROBATION": "not used yet: on probation"}
_JUDGED: Final = ("HEALTHY", SUSPECT, DISABLED)
# As many that go within so short a time are told in lines of their own.
_TOGETHER: Final = 2
_TOGETHER_S: Final = 1.0
_RAISED: Final = "SONAR_SUSPECT"
_ENDED: Final = frozenset(("SUSPICION_DROPPED", "SONAR_CLEARED", "SONAR_HEALTHY", "SONAR_DISABLED"))
_DISABLED: Final = "SONAR_DISABLED"
_KNOWN_BETTER: Final = "SONAR_KIND"
_BEGUN: Final = "SESSION_OPEN"
_UNSEEN: Final = 0xFFFFFFFF
# What follows from a disabled sonar, and what a manager that only listens would have liked to do.
_OWN: Final = frozenset(("health", "plan", "task", "object"))
_OWN_DRIVE: Final = frozenset(("WAITING", "STOPPED", "BACKING", "TURN_BLOCKED", "TURN_FAILED"))
_WARN: Final = 1
_SIP_S: Final = TIMING["SIP_CYCLE_MS"] / 1000


class Summary:
    """Takes every event; `lines` tells what is left of them at the end."""

    def __init__(self) -> None:
        self._since: dict[int, float] = {}
        self._suspicions = 0
        self._disabled: dict[int, tuple[str, float, str]] = {}
        self._earlier: dict[int, tuple[str, float, str]] = {}
        self._also: Counter[str] = Counter()
        self._meaning: dict[str, str] = {}
        self._first: float | None = None
        self._now = 0.0

    def see(self, t: float | None, is_sip: bool) -> None:
        """Take note of the log's time; of one that keeps none, each SIP is one cycle."""
        self._now = t if t is not None else self._now + _SIP_S * is_sip
        if self._first is None:
            self._first = self._now

    def see_all(self, rows: Sequence[Row]) -> None:
        """Take note of the times of packets and damage that follow each other."""
        if rows and self._first is None:
            self.see(rows[0].t, rows[0].type == "SIP" and rows[0].ok)
            rows = rows[1:]
        # Of those with times the last one counts, and what comes behind it.
        last = next((n for n in range(len(rows) - 1, -1, -1) if rows[n].t is not None), 0)
        for row in rows[last:]:
            self.see(row.t, row.type == "SIP" and row.ok)

    def add(self, event: CoreEvent, t: float | None, offset: int) -> None:
        """Take the next event, with the log's time if it keeps one, and the place of the packet that brought it."""
        name = event.event
        if name == _BEGUN:
            self._earlier |= self._disabled
            self._disabled.clear()
            self._since.clear()
        if event.sonar is None:
            if event.level >= _WARN and event.name not in _OWN and name not in _OWN_DRIVE:
                self._also[name] += 1
                self._meaning[name] = event.meaning.partition(";")[0].partition(":")[0]
        elif name == _RAISED:
            self._suspicions += 1
            self._since.setdefault(event.sonar, self._now)
        elif name in _ENDED:
            self._since.pop(event.sonar, None)
        if name == _DISABLED and event.sonar is not None:
            place = f"byte {offset}" if t is None else f"+{t - (self._first or 0.0):.1f} s"
            self._disabled[event.sonar] = (kind_name(event.value), self._now, place)
        elif name == _KNOWN_BETTER and event.sonar in self._disabled:
            self._disabled[event.sonar] = (kind_name(event.value), *self._disabled[event.sonar][1:])

    def lines(
        self, status: dict[str, Any], unread: int, unborne: Sequence[int] = (), unheard: Sequence[int] = ()
    ) -> list[str]:
        """Return the lines, of what the manager knows at the end and how many places of the file were not read.

        unborne: sonars that gave no reading while the log was damaged. unheard: those that gave only no echo.
        """
        health = status["health"]
        out = self._gone(health)
        out += [
            f"{_name(number):<14} disabled as {kind} at {place}, in an earlier session"
            for number, (kind, _, place) in sorted(self._earlier.items())
            if health[number] != DISABLED
        ]
        lasting = self._lasting(status)
        out += self._suspects(lasting, status["kind"])
        out += [
            f"{_name(number):<14} {_ELSE[state]}" for number, state in enumerate(health) if state in _ELSE
        ]
        out += [
            f"{_name(number):<14} gave no reading where the log is damaged: no verdict of silence"
            for number in unborne
            if health[number] == "UNKNOWN"
        ]
        out += _open([number for number in unheard if health[number] == "UNKNOWN"])
        is_judged = any(state in _JUDGED for state in health)
        head = (
            ""
            if out or not is_judged
            else "nothing wrong with the sonars: "
            if self._also
            else "nothing wrong: "
        )
        out.append(head + self._counts(status, len(lasting), unread))
        if self._also:
            said = (f"{count} x {name} ({self._meaning[name]})" for name, count in self._also.most_common())
            out.append("also: " + "; ".join(said))
        return out

    def has_faults(self, status: dict[str, Any]) -> bool:
        """Whether a sonar is or was disabled, yields no reading any more, or is a suspect with a name for its fault."""
        health = status["health"]
        is_out = bool(self._earlier) or any(state in (DISABLED, "STALE") for state in health)
        return is_out or 0 < len(self._lasting(status)) <= SUSPECTS_MAX

    def _lasting(self, status: dict[str, Any]) -> list[int]:
        """The suspects; a doubt without a name is not acted on, so it is not told either."""
        return [
            number
            for number, since in sorted(self._since.items())
            if status["health"][number] == SUSPECT
            and status["kind"][number]
            and self._now - since >= LASTING_S
        ]

    def _gone(self, health: list[str]) -> list[str]:
        """Tell of the disabled sonars, those that went together in one line."""
        groups: list[list[int]] = []
        for number, (kind, at, _) in sorted(self._disabled.items(), key=lambda item: item[1]):
            if health[number] != DISABLED:
                continue
            first = self._disabled[groups[-1][0]] if groups else None
            if first and first[0] == kind and at - first[1] <= _TOGETHER_S:
                groups[-1].append(number)
            else:
                groups.append([number])
        out = []
        for numbers in sorted(map(sorted, groups)):
            if len(numbers) > _TOGETHER:
                kind, _, place = min(self._disabled[number] for number in numbers)
                who = f"{len(numbers)} sonars ({', '.join(map(str, numbers))})"
                out.append(f"{who} disabled as {kind} at {place}, all at once")
            else:
                out += [
                    f"{_name(number):<14} disabled as {self._disabled[number][0]} at {self._disabled[number][2]}"
                    for number in numbers
                ]
        return out

    def _suspects(self, lasting: list[int], kinds: list[str]) -> list[str]:
        if len(lasting) > SUSPECTS_MAX:
            return [
                f"{len(lasting)} sonars ({', '.join(map(str, lasting))}) are suspects at once and none is proven: that "
                "is the place or the motion rather than the sonars"
            ]
        out = []
        for number in lasting:
            held = f"for the last {self._now - self._since[number]:.0f} s"
            out.append(f"{_name(number):<14} suspect {held}, perhaps {kinds[number]}; not proven")
        return out

    def _counts(self, status: dict[str, Any], lasting: int, unread: int) -> str:
        seen = [
            health for health, age in zip(status["health"], status["age_ms"], strict=True) if age != _UNSEEN
        ]
        judged = [health for health in seen if health in _JUDGED]
        healthy = len(judged) - judged.count(DISABLED) - lasting
        who = f"{healthy} of {len(seen)} sonars healthy" if judged else "too little to judge a sonar by"
        counts = [f"{who} in {status['sips']} SIPs over {self._now - (self._first or 0.0):.0f} s"]
        passed = self._suspicions - lasting
        if passed > 0:
            counts.append(f"{passed} suspicion{'s' * (passed > 1)} came and went")
        if status["bad_checksums"] or status["skipped_bytes"]:
            counts.append(f"{status['bad_checksums']} bad checksums, {status['skipped_bytes']} bytes skipped")
        if unread:
            counts.append(f"{unread} place{'s' * (unread > 1)} of the file could not be read")
        return "; ".join(counts)


def _open(unheard: Sequence[int]) -> list[str]:
    """Tell of sonars that may be dead or right, several in one line."""
    what = "gave only no echo, and nothing that others heard contradicts it: not judged"
    if len(unheard) > _TOGETHER:
        return [f"{len(unheard)} sonars ({', '.join(map(str, unheard))}) {what}"]
    return [f"{_name(number):<14} {what}" for number in unheard]


def _name(sonar: int) -> str:
    return CoreEvent(0, 0, sonar, "", 0).name
