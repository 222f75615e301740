# SPDX-License-Identifier: MIT
"""Injected faults: of sonars, of the link and of the bumper, written as short texts and executed when due."""

from __future__ import annotations

import math
import re
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from hil_sim.errors import SimError
from hil_sim.sonar import MIN_MM, NO_ECHO_MM, PER_ARRAY, SONAR_POSES
from hil_sim.tables import load
from hil_sim.world import Pose

SONAR_KINDS: Final = {
    "off": "reads 5000 in each of its slots",
    "silent": "its slots yield no reading",
    "stuck": "repeats the reading at onset, or value=MM",
    "wrong": "scale=FACTOR, then offset=MM; or angle=DEG: the range seen along its axis + angle",
    "garbage": "uniform from 100 to 5000",
    "slow": "reports the echo of n=COUNT firings ago (default 5)",
    "intermittent": "each reading is 5000 with probability p=P (default 0.5); beyond=MM: farther echoes only",
}
LINK_KINDS: Final = {
    "link-drop": "loses packets with probability p=P (default 1)",
    "link-corrupt": "damages packets with probability p=P (default 1)",
    "link-delay": "holds every packet for ms=MS",
    "link-cut": "lets nothing through",
}
DIRECTIONS: Final = ("both", "to_client", "to_robot")
BUMPER_SEGMENTS: Final[int] = load("robots/p3dx-sh")["body"]["front_bumpers"]
SONARS: Final = len(SONAR_POSES)
_TARGETS: Final = {"front": range(PER_ARRAY), "rear": range(PER_ARRAY, SONARS), "all": range(SONARS)}
_SLOW_MAX: Final = 100
_FAR: Final = 1e7
"""Seconds or mm: no run gets there, so a bound beyond it is a slip."""


@dataclass(frozen=True)
class When:
    """One bound in time or place: `variable` is t (ms), x, y or travelled (mm); `sign` +1 above, -1 below."""

    variable: str
    sign: int
    value: float

    def met(self, now_ms: float, pose: Pose, travelled_mm: float) -> bool:
        """The bound is passed."""
        here = {"t": now_ms, "x": pose.x_mm, "y": pose.y_mm, "travelled": travelled_mm}[self.variable]
        return here >= self.value if self.variable == "t" else (here - self.value) * self.sign > 0


@dataclass(frozen=True)
class Ramp:
    """How long a fault grows: `variable` is t (`length` in ms) or travelled (mm)."""

    variable: str
    length: float

    def grown(self, since: float, here: float) -> float:
        """Return the part of the fault that is there, 0 to 1."""
        return min(1.0, max(0.0, (here - since) / self.length))


@dataclass(frozen=True)
class Fault:
    """Anything that can be injected; `text` is what it was written as."""

    text: str

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True)
class SonarFault(Fault):
    """A fault of sonars, on from `start` to `end`; None: from the beginning, for good."""

    kind: str
    sonars: tuple[int, ...]
    start: When | None = None
    end: When | None = None
    value: int | None = None
    scale: float = 1.0
    offset: float = 0.0
    angle: float | None = None
    n: int = 5
    p: float = 0.5
    beyond: int | None = None
    ramp: Ramp | None = None


@dataclass(frozen=True)
class BumperHit(Fault):
    """A press of front bumper segment 1 (leftmost) to 5."""

    segment: int
    start_ms: float
    end_ms: float


@dataclass(frozen=True)
class LinkFault(Fault):
    """A disturbance of the link; `kind` is drop, corrupt, delay or cut; `end_ms` None: for good."""

    kind: str
    start_ms: float = 0.0
    end_ms: float | None = None
    probability: float = 1.0
    delay_ms: float = 0.0
    direction: str = "both"


@dataclass(frozen=True)
class FaultChange:
    """A fault of one sonar, or a bumper hit, that began (`on`) or ended."""

    t_ms: float
    kind: str
    on: bool
    text: str
    sonar: int | None = None
    segment: int | None = None

    def as_record(self) -> dict[str, Any]:
        """Return the change as fields of the truth record."""
        fields: dict[str, Any] = {"kind": self.kind, "on": self.on, "text": self.text}
        if self.sonar is not None:
            fields["sonar"] = self.sonar
        if self.segment is not None:
            fields["segment"] = self.segment
        return fields


# ---- grammar (docs/scenarios.md) --------------------------------------------------------------------------------

_FORM = re.compile(r"(?P<kind>[a-z-]+)(?::(?P<target>[^@:]*))?(?:@(?P<when>[^:]*))?(?P<rest>(?::[^:]*)*)")
_TIME = re.compile(r"(\d+(?:\.\d+)?)s")
_PLACE = re.compile(r"(x|y|travelled)([<>])(-?\d+(?:\.\d+)?)")
_PARAMETERS: Final = {
    "off": (),
    "silent": (),
    "stuck": ("value",),
    "wrong": ("scale", "offset", "angle", "ramp"),
    "garbage": (),
    "slow": ("n",),
    "intermittent": ("p", "beyond", "ramp"),
    "bumper": (),
    "link-drop": ("p", "dir"),
    "link-corrupt": ("p", "dir"),
    "link-delay": ("ms", "dir"),
    "link-cut": ("dir",),
}
_LIMITS: Final = {
    "value": (MIN_MM, NO_ECHO_MM),
    "scale": (0.0, 50.0),
    "offset": (-NO_ECHO_MM, NO_ECHO_MM),
    "angle": (-180.0, 180.0),
    "n": (1, _SLOW_MAX),
    "p": (0.0, 1.0),
    "beyond": (MIN_MM, NO_ECHO_MM),
    "ms": (0.0, 60_000.0),
}
_WHOLE: Final = ("value", "n", "beyond")


def fault_help() -> str:
    """Return the list of faults with their grammar, for people."""
    kinds = [f"  {kind:<13} {what}" for kind, what in (SONAR_KINDS | LINK_KINDS).items()]
    return "\n".join(
        [
            "KIND:TARGET[@FROM[-TO]][:NAME=VALUE...]   a fault of sonars; TARGET 0 to 15, 3+6, front, rear or all",
            "bumper:SEGMENT@FROM[-TO]                  front bumper segment 1 (left) to 5, 0.5 s unless TO is given",
            "link-KIND[@FROM[-TO]][:NAME=VALUE...]     a fault of the link, times only; dir=both, to_client, to_robot",
            "",
            "FROM and TO are times (12s) or places: x>2000, x<0, y>500, y<500, travelled>1500 (mm, true pose).",
            "Without FROM a fault is there from the beginning; without TO it stays. A place once passed counts as",
            "passed. Where two faults hit one sonar, the one written last wins.",
            "",
            *kinds,
            "",
            "wrong and intermittent grow from nothing (beyond: from 5000) within ramp=60s or ramp=20000 mm of way.",
            "",
            "examples: off:3@12s   wrong:6@x>2000:scale=0.5   stuck:2@10s-20s:value=400   silent:rear@travelled>1500",
            "          intermittent:front@5s:p=0.3   bumper:3@8s-9s   link-corrupt@3s-9s:p=0.2:dir=to_client",
            "          wrong:3@20s:offset=-400:ramp=30000   intermittent:2:p=1:beyond=2000:ramp=300s",
        ]
    )


def parse_fault(text: str) -> Fault:
    """Parse a fault; raises SimError that says what is wrong with it.

    >>> parse_fault("off:3@12s").start.value
    12000.0
    """
    match = _FORM.fullmatch(text.strip())
    kind = match["kind"] if match else ""
    if match is None or kind not in _PARAMETERS:
        raise SimError(f"fault '{text}': expected KIND:TARGET@FROM with KIND one of {', '.join(_PARAMETERS)}")
    target, rest = match["target"], match["rest"]
    if kind.startswith("link-") and target and "=" in target and match["when"] is None:
        target, rest = None, f":{target}{rest}"
    values = _parameters(text, kind, rest)
    if kind.startswith("link-"):
        if target:
            raise SimError(f"fault '{text}': a link fault has no target; write {kind}@FROM-TO")
        return _link_fault(text, kind, match["when"], values)
    if not target:
        raise SimError(f"fault '{text}': which one? write {kind}:3 for number 3")
    if kind == "bumper":
        return _bumper(text, target, match["when"])
    start, end = _bounds(text, match["when"])
    numbers = {name: value for name, value in values.items() if not isinstance(value, str)}
    if kind == "wrong" and not values.keys() - {"ramp"}:
        raise SimError(f"fault '{text}': wrong in what way? add :scale=0.5, :offset=-200 or :angle=20")
    return SonarFault(text.strip(), kind, _sonars(text, target), start, end, **numbers)  # type: ignore[arg-type]


def _parameters(text: str, kind: str, rest: str) -> dict[str, float | str | Ramp]:
    known = _PARAMETERS[kind]
    values: dict[str, float | str | Ramp] = {}
    for part in rest.split(":")[1:]:
        name, equals, value = part.partition("=")
        if not equals or name not in known:
            offer = ", ".join(f"{k}=" for k in known) or "none"
            raise SimError(f"fault '{text}': '{part}' is no parameter of {kind}; it takes {offer}")
        if name in values:
            raise SimError(f"fault '{text}': {name} is given twice; keep one")
        if name == "dir":
            values[name] = _direction(text, value)
        elif name == "ramp":
            values[name] = _ramp(text, value)
        else:
            values[name] = _value(text, name, value)
    return values


def _ramp(text: str, value: str) -> Ramp:
    time = _TIME.fullmatch(value)
    number = time[1] if time else value if re.fullmatch(r"\d+(\.\d+)?", value) else "0"
    if not 0 < float(number) <= _FAR:
        raise SimError(
            f"fault '{text}': ramp must be a time such as 60s or mm of way such as 20000, not '{value}'"
        )
    return Ramp("t", float(number) * 1000) if time else Ramp("travelled", float(number))


def _direction(text: str, value: str) -> str:
    if value not in DIRECTIONS:
        raise SimError(f"fault '{text}': dir is one of {', '.join(DIRECTIONS)}")
    return value


def _value(text: str, name: str, value: str) -> float:
    low, high = _LIMITS[name]
    try:
        number = int(value) if name in _WHOLE else float(value)
    except ValueError:
        number = math.nan
    if not low <= number <= high:
        what = "a whole number" if name in _WHOLE else "a number"
        raise SimError(f"fault '{text}': {name} must be {what} from {low:g} to {high:g}, not '{value}'")
    return number


def _sonars(text: str, target: str) -> tuple[int, ...]:
    if target in _TARGETS:
        return tuple(_TARGETS[target])
    parts = target.split("+")
    if not all(re.fullmatch(r"\d{1,2}", part) and int(part) < SONARS for part in parts):
        raise SimError(
            f"fault '{text}': '{target}' is no sonar; name 0 to {SONARS - 1}, 3+6, front, rear or all"
        )
    return tuple(sorted({int(part) for part in parts}))


def _bounds(text: str, when: str | None) -> tuple[When | None, When | None]:
    if when is None:
        return None, None
    # A "-" ends the first bound unless it is the sign of a number, which follows < or >.
    parts = re.split(r"(?<![<>])-", when)
    if len(parts) > 2:
        raise SimError(f"fault '{text}': '{when}' has more than a FROM and a TO")
    bounds = [_bound(text, part) for part in parts]
    start, end = bounds[0], bounds[1] if len(bounds) == 2 else None
    if end is not None and start.variable == end.variable == "t" and end.value <= start.value:
        raise SimError(f"fault '{text}': it ends before it begins; exchange the times")
    return start, end


def _bound(text: str, part: str) -> When:
    if (match := _TIME.fullmatch(part)) and float(match[1]) <= _FAR:
        return When("t", 1, float(match[1]) * 1000)
    if (match := _PLACE.fullmatch(part)) and abs(float(match[3])) <= _FAR:
        return When(match[1], 1 if match[2] == ">" else -1, float(match[3]))
    raise SimError(
        f"fault '{text}': '{part}' is no time or place; write 12s, x>2000, y<-300 or travelled>1500"
    )


def _times(text: str, when: str | None) -> tuple[float, float | None]:
    start, end = _bounds(text, when)
    if any(bound is not None and bound.variable != "t" for bound in (start, end)):
        raise SimError(f"fault '{text}': this kind takes times only, for example @3s-9s")
    return start.value if start else 0.0, end.value if end else None


def _bumper(text: str, target: str, when: str | None) -> BumperHit:
    if not re.fullmatch(r"\d", target) or not 1 <= int(target) <= BUMPER_SEGMENTS:
        raise SimError(f"fault '{text}': '{target}' is no bumper segment; name 1 (left) to {BUMPER_SEGMENTS}")
    if when is None:
        raise SimError(f"fault '{text}': when? write bumper:{target}@8s or bumper:{target}@8s-9s")
    start, end = _times(text, when)
    return BumperHit(text.strip(), int(target), start, start + 500 if end is None else end)


def _link_fault(
    text: str, kind: str, when: str | None, values: Mapping[str, float | str | Ramp]
) -> LinkFault:
    start, end = _times(text, when)
    if kind == "link-delay" and "ms" not in values:
        raise SimError(f"fault '{text}': how long? add :ms=250")
    return LinkFault(
        text.strip(),
        kind.removeprefix("link-"),
        start,
        end,
        probability=_number(values, "p", 1.0),
        delay_ms=_number(values, "ms", 0.0),
        direction=str(values.get("dir", "both")),
    )


def _number(values: Mapping[str, float | str | Ramp], name: str, default: float) -> float:
    value = values.get(name, default)
    assert isinstance(value, (int, float))
    return value


# ---- execution --------------------------------------------------------------------------------------------------


class _State:
    """How far one sonar fault has come."""

    def __init__(self, fault: SonarFault) -> None:
        self.fault = fault
        self.started = fault.start is None
        self.ended = False
        self.told = False
        self.held: dict[int, int] = {}
        self.since: float | None = None
        self.part = 1.0 if fault.ramp is None else 0.0

    def grow(self, now_ms: float, travelled_mm: float) -> None:
        """Let a fault with a ramp grow, from where it began."""
        ramp = self.fault.ramp
        if ramp is not None and self.on:
            here = now_ms if ramp.variable == "t" else travelled_mm
            self.since = here if self.since is None else self.since
            self.part = ramp.grown(self.since, here)

    @property
    def on(self) -> bool:
        return self.started and not self.ended


class FaultSet:
    """Executes the sonar faults and bumper hits of a run; link faults among them are left to the link."""

    def __init__(self, faults: Iterable[Fault] = (), rng: np.random.Generator | None = None) -> None:
        self.faults = list(faults)
        self._rng = rng if rng is not None else np.random.default_rng(0)
        self._states = [_State(fault) for fault in self.faults if isinstance(fault, SonarFault)]
        self._hits = [fault for fault in self.faults if isinstance(fault, BumperHit)]
        self._pressed = [False] * len(self._hits)
        self._afflicted = {number for state in self._states for number in state.fault.sonars}
        self._waiting = list(self._states)
        self._slowest = {
            number: max(state.fault.n for state in self._states if number in state.fault.sonars)
            for number in {
                n for state in self._states if state.fault.kind == "slow" for n in state.fault.sonars
            }
        }
        self._echoes: dict[int, deque[int]] = {
            n: deque(maxlen=count + 1) for n, count in self._slowest.items()
        }

    @property
    def link_faults(self) -> list[LinkFault]:
        """The faults of the link."""
        return [fault for fault in self.faults if isinstance(fault, LinkFault)]

    def update(self, now_ms: float, pose: Pose, travelled_mm: float) -> list[FaultChange]:
        """Begin and end faults; return what changed. Call it before the ring fires."""
        changes: list[FaultChange] = []
        if not self._waiting and not self._hits:
            return changes
        for state in self._waiting:
            if state.ended:
                continue
            fault = state.fault
            if not state.started:
                assert fault.start is not None
                state.started = fault.start.met(now_ms, pose, travelled_mm)
            if state.started and fault.end is not None:
                state.ended = fault.end.met(now_ms, pose, travelled_mm)
            state.grow(now_ms, travelled_mm)
            if state.on != state.told:
                state.told = state.on
                changes += [
                    FaultChange(now_ms, fault.kind, state.on, fault.text, sonar=number)
                    for number in fault.sonars
                ]
        if changes:
            # What has ended, or is on for good, does not change any more.
            self._waiting = [
                s
                for s in self._waiting
                if not s.ended and (not s.on or s.fault.end is not None or s.part < 1.0)
            ]
        for k, hit in enumerate(self._hits):
            pressed = hit.start_ms <= now_ms < hit.end_ms
            if pressed != self._pressed[k]:
                self._pressed[k] = pressed
                changes.append(FaultChange(now_ms, "bumper", pressed, hit.text, segment=hit.segment))
        return changes

    def active(self, number: int) -> SonarFault | None:
        """Return the fault that has sonar 0 to 15 now: of several the one written last."""
        for state in reversed(self._states):
            if state.on and number in state.fault.sonars:
                return state.fault
        return None

    def apply(
        self, number: int, now_ms: float, true_measured_mm: int, remeasure: Callable[[float], int]
    ) -> tuple[int | None, str | None]:
        """Return what a sonar reports for what it measured, None for a silent slot, and the fault's kind.

        `remeasure(angle_deg)` gives what it would have measured with its axis turned.
        """
        del now_ms  # `update` has decided what is on
        if number not in self._afflicted:
            return true_measured_mm, None
        echoes = self._echoes.get(number)
        if echoes is not None:
            echoes.append(true_measured_mm)
        for state in self._states:
            # Also while another fault hides it: the reading at onset is what counts.
            if state.fault.kind == "stuck" and state.on and number in state.fault.sonars:
                value = state.fault.value
                state.held.setdefault(number, true_measured_mm if value is None else value)
        for state in reversed(self._states):
            if state.on and number in state.fault.sonars:
                return self._report(state, number, true_measured_mm, remeasure), state.fault.kind
        return true_measured_mm, None

    def _report(
        self, state: _State, number: int, measured: int, remeasure: Callable[[float], int]
    ) -> int | None:
        fault = state.fault
        if fault.kind == "off":
            return NO_ECHO_MM
        if fault.kind == "silent":
            return None
        if fault.kind == "stuck":
            return state.held[number]
        if fault.kind == "garbage":
            return int(self._rng.integers(MIN_MM, NO_ECHO_MM + 1))
        if fault.kind == "slow":
            echoes = self._echoes[number]
            return echoes[max(0, len(echoes) - 1 - fault.n)]
        if fault.kind == "intermittent":
            return self._drop(state, measured)
        base = measured if fault.angle is None else remeasure(fault.angle * state.part)
        scale = 1.0 + (fault.scale - 1.0) * state.part
        return int(min(NO_ECHO_MM, max(MIN_MM, round(base * scale + fault.offset * state.part))))

    def _drop(self, state: _State, measured: int) -> int:
        fault = state.fault
        if fault.beyond is None:
            lost = self._rng.random() < fault.p * state.part
        else:
            hears_to = NO_ECHO_MM + (fault.beyond - NO_ECHO_MM) * state.part
            lost = self._rng.random() < fault.p and measured > hears_to
        return NO_ECHO_MM if lost else measured

    def bumper(self, now_ms: float) -> int:
        """Return the front bumper bits that hits press now: bit 1 leftmost to bit 5 rightmost."""
        mask = 0
        for hit in self._hits:
            if hit.start_ms <= now_ms < hit.end_ms:
                mask |= 1 << hit.segment
        return mask
