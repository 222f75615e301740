# SPDX-License-Identifier: MIT
"""The grammar in which faults are written (docs/scenarios.md)."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Final

from hil_sim.arguments import offer
from hil_sim.errors import SimError
from hil_sim.faults.kinds import (
    DIRECTIONS,
    LINK_KINDS,
    SONAR_KINDS,
    WHEEL_KINDS,
    BumperHit,
    Fault,
    LinkFault,
    Ramp,
    SonarFault,
    WheelFault,
    When,
)
from hil_sim.sonar.params import MIN_MM, NO_ECHO_MM
from hil_sim.tables.robot import RobotTable, robot_table

_BUMPER_SEGMENTS: Final = 5
WIRE_MAX: Final = 65535
"""The largest range that a SIP can carry."""
_SLOW_MAX: Final = 100
_WHEELS: Final = ("left", "right")
_WHEEL_LEAST: Final = 0.5
_FAR: Final = 1e7
"""Seconds or mm: no run gets there, so a bound beyond it is a slip."""
_FORM = re.compile(r"(?P<kind>[a-z-]+)(?::(?P<target>[^@:]*))?(?:@(?P<when>[^:]*))?(?P<rest>(?::[^:]*)*)")
_TIME = re.compile(r"(\d+(?:\.\d+)?)s")
_PLACE = re.compile(r"(x|y|travelled)([<>])(-?\d+(?:\.\d+)?)")
_PARAMETERS: Final = {
    "off": (),
    "silent": (),
    "stuck": ("value",),
    "wrong": ("scale", "offset", "angle", "ramp", "low", "high"),
    "garbage": ("low", "high"),
    "slow": ("n",),
    "intermittent": ("p", "beyond", "ramp", "value"),
    "bumper": (),
    "wheel": (),
    "link-drop": ("p", "dir"),
    "link-corrupt": ("p", "dir"),
    "link-delay": ("ms", "dir"),
    "link-cut": ("dir",),
}
_LIMITS: Final = {
    "value": (0, WIRE_MAX),
    "low": (0, WIRE_MAX),
    "high": (0, WIRE_MAX),
    "scale": (0.0, 50.0),
    "offset": (-WIRE_MAX, WIRE_MAX),
    "angle": (-180.0, 180.0),
    "n": (1, _SLOW_MAX),
    "p": (0.0, 1.0),
    "beyond": (MIN_MM, NO_ECHO_MM),
    "ms": (0.0, 60_000.0),
}
_WHOLE: Final = ("value", "n", "beyond", "low", "high")


def fault_help() -> str:
    """Return the list of faults with their grammar, for people."""
    kinds = [f"  {kind:<13} {what}" for kind, what in (SONAR_KINDS | WHEEL_KINDS | LINK_KINDS).items()]
    return "\n".join(
        [
            "KIND:TARGET[@FROM[-TO]][:NAME=VALUE...]   a fault of sonars; TARGET 3, 3+6, front, rear or all",
            "bumper:SEGMENT@FROM[-TO]                  front bumper segment 1 (left) to 5, 0.5 s unless TO is given",
            "wheel:SIDE[@FROM[-TO]]:PART               a wheel, left or right, that turns PART of what it is told",
            "link-KIND[@FROM[-TO]][:NAME=VALUE...]     a fault of the link, times only; dir=both, to_client, to_robot",
            "",
            "FROM and TO are times (12s) or places: x>2000, x<0, y>500, y<500, travelled>1500 (mm, true pose).",
            "Without FROM a fault is there from the beginning; without TO it stays. A place once passed counts as",
            "passed. Where two faults hit one sonar, the one written last wins.",
            "",
            *kinds,
            "",
            "Readings are clipped to 100..5000 unless low= and high= (0 to 65535) say otherwise.",
            "wrong and intermittent grow from nothing (beyond: from 5000) within ramp=60s or ramp=20000 mm of way.",
            "",
            "examples: off:3@12s   wrong:6@x>2000:scale=0.5   stuck:2@10s-20s:value=400   silent:rear@travelled>1500",
            "          intermittent:front@5s:p=0.3   bumper:3@8s-9s   link-corrupt@3s-9s:p=0.2:dir=to_client",
            "          wrong:3@20s:offset=-400:ramp=30000   intermittent:2:p=1:beyond=2000:ramp=300s",
            "          wheel:left:0.95   wheel:right@10s-20s:0.9",
        ]
    )


def parse_fault(text: str, robot: RobotTable | None = None) -> Fault:
    """Parse a fault of a robot (None: of the default one); raises SimError that says what is wrong with it.

    >>> parse_fault("off:3@12s").start.value
    12000.0
    """
    match = _FORM.fullmatch(text.strip())
    kind = match["kind"] if match else ""
    if match is None:
        raise SimError(f"fault '{text}': expected KIND:TARGET@FROM with KIND one of {', '.join(_PARAMETERS)}")
    if kind not in _PARAMETERS:
        raise SimError(f"fault '{text}': KIND:TARGET@FROM has no kind '{kind}'{offer(kind, _PARAMETERS)}")
    if kind.startswith("link-"):
        return _link_fault(text, kind, match)
    target = match["target"]
    if kind == "wheel":
        return _wheel(text, target, match["when"], match["rest"])
    values = _parameters(text, kind, match["rest"])
    if not target:
        raise SimError(f"fault '{text}': which one? write {kind}:3 for number 3")
    if kind == "bumper":
        return _bumper(text, target, match["when"])
    table = robot if robot is not None else robot_table()
    return _sonar_fault(text, kind, _sonars(text, target, table), match["when"], values)


def _sonar_fault(
    text: str, kind: str, sonars: tuple[int, ...], when: str | None, values: Mapping[str, float | str | Ramp]
) -> SonarFault:
    start, end = _bounds(text, when)
    numbers = {name: value for name, value in values.items() if not isinstance(value, str)}
    if kind == "wrong" and not values.keys() - {"ramp"}:
        raise SimError(f"fault '{text}': wrong in what way? add :scale=0.5, :offset=-200 or :angle=20")
    low, high = values.get("low", MIN_MM), values.get("high", NO_ECHO_MM)
    if not isinstance(low, int) or not isinstance(high, int) or low > high:
        raise SimError(f"fault '{text}': low is {low} and high is {high}; exchange them")
    return SonarFault(text.strip(), kind, sonars, start, end, **numbers)  # type: ignore[arg-type]


def _parameters(text: str, kind: str, rest: str) -> dict[str, float | str | Ramp]:
    known = _PARAMETERS[kind]
    values: dict[str, float | str | Ramp] = {}
    for part in rest.split(":")[1:]:
        name, equals, value = part.partition("=")
        if not equals or name not in known:
            takes = offer(f"{name}=", [f"{k}=" for k in known])
            raise SimError(f"fault '{text}': '{part}' is no parameter of {kind}{takes}")
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
        raise SimError(f"fault '{text}': no dir '{value}'{offer(value, DIRECTIONS)}")
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


def _sonars(text: str, target: str, robot: RobotTable) -> tuple[int, ...]:
    groups = {"front": robot.front, "rear": robot.rear, "all": tuple(range(robot.sonars))}
    if target in groups:
        return groups[target]
    parts = target.split("+")
    if not all(re.fullmatch(r"\d{1,2}", part) and int(part) < robot.sonars for part in parts):
        raise SimError(
            f"fault '{text}': '{target}' is no sonar of {robot.subclass}; "
            f"name 0 to {robot.sonars - 1}, 3+6, front, rear or all"
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
    if not re.fullmatch(r"\d", target) or not 1 <= int(target) <= _BUMPER_SEGMENTS:
        raise SimError(
            f"fault '{text}': '{target}' is no bumper segment; name 1 (left) to {_BUMPER_SEGMENTS}"
        )
    if when is None:
        raise SimError(f"fault '{text}': when? write bumper:{target}@8s or bumper:{target}@8s-9s")
    start, end = _times(text, when)
    return BumperHit(text.strip(), int(target), start, start + 500 if end is None else end)


def _wheel(text: str, side: str | None, when: str | None, rest: str) -> WheelFault:
    if side not in _WHEELS:
        raise SimError(f"fault '{text}': which wheel? write wheel:left:0.95 or wheel:right:0.95")
    part = float(rest[1:]) if re.fullmatch(r":\d+(\.\d+)?", rest) else 0.0
    if not _WHEEL_LEAST <= part <= 1:
        raise SimError(
            f"fault '{text}': it ends with the part that is left, {_WHEEL_LEAST:g} to 1, as in :0.95"
        )
    start, end = _bounds(text, when)
    return WheelFault(text.strip(), side, part, start, end)


def _link_fault(text: str, kind: str, match: re.Match[str]) -> LinkFault:
    target, when, rest = match["target"], match["when"], match["rest"]
    if target and "=" in target and when is None:
        target, rest = None, f":{target}{rest}"
    values = _parameters(text, kind, rest)
    if target:
        raise SimError(f"fault '{text}': a link fault has no target; write {kind}@FROM-TO")
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
