# SPDX-License-Identifier: MIT
"""One short run, under virtual time or with argusd on a pty, and what both say of it, told alike."""

from __future__ import annotations

import math
import re
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, NamedTuple

import yaml

from hil_sim.demo.runner import Recording, Run, Setup
from hil_sim.errors import SimError
from hil_sim.sil import Event, Mission, Sighting, Sil
from hil_sim.world.files import load_world
from hil_sim.world.model import Pose

_SONAR: Final = re.compile(r"sonar/[a-z]+/(\d+)")
_STEP_S: Final = 0.1


class State(NamedTuple):
    """Where the robot truly was."""

    t_s: float
    x_mm: float
    y_mm: float
    heading_deg: float


class Heard(NamedTuple):
    """One reading."""

    t_s: float
    sonar: int
    range_mm: int


@dataclass
class Seen:
    """What came of a run: events of the fault manager by its own clock; states and readings by the robot's."""

    events: list[Event] = field(default_factory=list)
    states: list[State] = field(default_factory=list)
    readings: list[Heard] = field(default_factory=list)

    def values(self, name: str) -> list[int]:
        """Return the values of all events of a name."""
        return [event.value for event in self.events if event.name == name]


@dataclass(frozen=True)
class Stage:
    """How runs are made. argusd: the program to drive a pty with; None: under virtual time."""

    argusd: Path | None = None

    def __call__(self, mission: Mission, until: Callable[[Seen], bool]) -> Seen:
        """Run until that is so, or to the mission's limit; SimError when a program fails."""
        return _virtual(mission, until) if self.argusd is None else _on_pty(mission, until, self.argusd)

    @property
    def says(self) -> str:
        """How, in words."""
        return "under virtual time" if self.argusd is None else "argusd on a pty"


def _virtual(mission: Mission, until: Callable[[Seen], bool]) -> Seen:
    seen = Seen()

    def note(_sil: Sil, sighting: Sighting) -> None:
        seen.states.append(State(sighting.t_s, *sighting.pose))
        seen.readings.extend(Heard(r.t_ms / 1000, r.number, r.range_mm) for r in sighting.readings)

    sil = Sil(mission, trace=note)
    seen.events = sil.events
    while not sil.over and not until(seen):
        sil.run_until(sil.now_ms / 1000 + _STEP_S)
    return seen


def _on_pty(mission: Mission, until: Callable[[Seen], bool], argusd: Path) -> Seen:
    seen = Seen()
    taken = {"events": 0, "truth": 0}

    def watch(recording: Recording) -> None:
        for event in recording.events[taken["events"] :]:
            _take_event(seen, event)
        for record in recording.truth[taken["truth"] :]:
            _take_truth(seen, record)
        taken["events"], taken["truth"] = len(recording.events), len(recording.truth)
        if until(seen):
            recording.ended = "seen"

    with tempfile.TemporaryDirectory(prefix="argus-stage-") as folder:
        Run(_setup(mission, Path(folder), argusd), watch)()
    return seen


def _take_event(seen: Seen, event: dict[str, Any]) -> None:
    match = _SONAR.fullmatch(str(event.get("name", "")))
    number = int(match[1]) if match else None
    value, state = event.get("value"), str(event.get("state", ""))
    if event.get("event") != "STATUS":
        seen.events.append(
            Event(
                float(event["t"]), str(event["event"]), number, value if isinstance(value, int) else 0, state
            )
        )


def _take_truth(seen: Seen, record: dict[str, Any]) -> None:
    if record.get("type") == "state":
        fields = (record["t_s"], record["x_mm"], record["y_mm"], record["heading_deg"])
        seen.states.append(State(*map(float, fields)))
    elif record.get("type") == "sonar":
        seen.readings.append(Heard(float(record["t_s"]), int(record["sonar"]), int(record["range_mm"])))


def _setup(mission: Mission, out: Path, argusd: Path) -> Setup:
    """The same run for two programs: a scenario, a course and settings as files."""
    start = Pose(*mission.start) if mission.start is not None else load_world(mission.world).start
    scenario = {
        "world": mission.world,
        "seed": mission.seed % 2**31,
        "start": [start.x_mm, start.y_mm, start.heading_deg],
        "sonar": dict(mission.sonar),
        "faults": list(mission.faults),
    }
    (out / "scenario.yaml").write_text(
        yaml.safe_dump({key: value for key, value in scenario.items() if value}), encoding="utf-8"
    )
    c, s = math.cos(math.radians(start.heading_deg)), math.sin(math.radians(start.heading_deg))
    away = [(x - start.x_mm, y - start.y_mm) for x, y in mission.course]
    points = [(x * c + y * s, y * c - x * s) for x, y in away]
    (out / "course").write_text("".join(f"{x:.0f},{y:.0f}\n" for x, y in points), encoding="utf-8")
    settings = "".join(f"{key} = {value}\n" for key, value in mission.config.items())
    (out / "argusd.conf").write_text(settings, encoding="utf-8")
    if not argusd.exists():
        raise SimError(f"{argusd}: there is no argusd; build it with tools/dev build release")
    arguments = ("--scenario", str(out / "scenario.yaml"))
    return Setup(out, argusd, arguments, out / "course", out / "argusd.conf", mission.limit_s)


def at_rest_since(seen: Seen, rest_s: float) -> bool:
    """Whether the robot has stood so long, on one heading."""
    if not seen.states or seen.states[-1].t_s - seen.states[0].t_s < rest_s:
        return False
    last = seen.states[-1]
    late: Sequence[State] = [state for state in seen.states[-200:] if state.t_s >= last.t_s - rest_s]
    return all(
        math.dist(state[1:3], last[1:3]) < 1.0 and abs(state.heading_deg - last.heading_deg) < 0.3
        for state in late
    )
