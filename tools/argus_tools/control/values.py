# SPDX-License-Identifier: MIT
"""What argusd reports on its control socket, as typed values with units in their names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

NO_ECHO_MM: Final = 5000
_SONAR: Final = ("sonar/front/", "sonar/rear/")


@dataclass(frozen=True)
class SonarHealth:
    """One sonar as the fault manager sees it.

    health: HEALTHY, SUSPECT, DISABLED, ... kind: the fault that is named, or "". reading_mm: 5000 is no echo, None: it
    never reported. injected: the fault that argusd itself makes for a test, or "".
    """

    number: int
    bearing_deg: int
    health: str
    kind: str
    reading_mm: int | None
    age_ms: int | None
    injected: str
    pinned: bool

    @property
    def in_use(self) -> bool:
        """Whether the robot relies on it."""
        return not self.kind and self.health in ("HEALTHY", "SUSPECT")

    def __str__(self) -> str:
        if self.reading_mm is None:
            reads = "never reported"
        elif self.reading_mm >= NO_ECHO_MM:
            reads = "no echo"
        else:
            reads = f"{self.reading_mm} mm"
        kind = f", {self.kind}" if self.kind else ""
        return f"sonar {self.number:>2} at {self.bearing_deg:>4} deg: {self.health}{kind}, {reads}"


@dataclass(frozen=True)
class RobotState:
    """All that argusd reports of the robot at one time; `raw` has what no member is made for (docs/argusd.md).

    time_s: since argusd began. mode: what it does. failure: IsNormal, IsMinor, IsMajor or IsCatastrophic. mission:
    none, running, reached or failed. Pose: from where it connected, ahead, to the left, counter-clockwise.
    """

    time_s: float
    online: bool
    robot: str
    subclass: str
    mode: str
    failure: str
    mission: str
    active: bool
    paused: bool
    motors: bool
    x_mm: int
    y_mm: int
    heading_deg: float
    goal_mm: int
    battery_v: float
    sonars: tuple[SonarHealth, ...]
    raw: Mapping[str, Any] = field(repr=False)

    @property
    def failing(self) -> tuple[SonarHealth, ...]:
        """The sonars that the robot does not rely on."""
        return tuple(sonar for sonar in self.sonars if not sonar.in_use)


@dataclass(frozen=True)
class LiveEvent:
    """Something that happened: its name in the catalogue, about which part, and a value that the catalogue explains."""

    time_s: float
    event: str
    id: int
    level: int
    about: str
    value: int
    failure: str

    @property
    def sonar(self) -> int | None:
        """The number of the sonar that it is about, None for anything else."""
        return int(self.about.rpartition("/")[2]) if self.about.startswith(_SONAR) else None


def state_of(raw: Mapping[str, Any]) -> RobotState:
    """Return a STATUS line as a value; a robot that is not connected has neither readings nor a pose yet."""
    count = int(raw.get("sonars", len(raw["health"])))
    sonars = tuple(
        SonarHealth(
            number=k,
            bearing_deg=raw["bearing_deg"][k],
            health=raw["health"][k],
            kind=raw["kind"][k],
            reading_mm=raw["reading_mm"][k] if raw["age_ms"][k] >= 0 else None,
            age_ms=raw["age_ms"][k] if raw["age_ms"][k] >= 0 else None,
            injected=raw["injected"][k],
            pinned=k in raw["pinned"],
        )
        for k in range(count)
    )
    return RobotState(
        time_s=raw["t"],
        online=raw["online"],
        robot=raw["robot"],
        subclass=raw["subclass"],
        mode=raw["mode"],
        failure=raw["state"],
        mission=raw["mission"],
        active=raw["active"],
        paused=raw["paused"],
        motors=raw["motors"],
        x_mm=raw["x_mm"],
        y_mm=raw["y_mm"],
        heading_deg=raw["heading_cdeg"] / 100,
        goal_mm=raw["goal_mm"],
        battery_v=raw["battery_dv"] / 10,
        sonars=sonars,
        raw=raw,
    )


def event_of(raw: Mapping[str, Any]) -> LiveEvent:
    """Return an event line as a value.

    >>> event_of({"t": 7.5, "event": "SONAR_NAMED", "id": 45, "level": 1, "name": "sonar/front/03", "value": 1,
    ...           "state": "IsNormal"}).sonar
    3
    """
    return LiveEvent(raw["t"], raw["event"], raw["id"], raw["level"], raw["name"], raw["value"], raw["state"])
