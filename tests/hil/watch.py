# SPDX-License-Identifier: MIT
"""The safety monitor over a drive of the HIL: the wire that argusd records, the truth, and what argusd reports."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, Final, NamedTuple

from argus_tools.chunks import CLIENT_TO_ROBOT
from argus_tools.formats import open_log
from harness import BAUD, Argusd, Bench, Record, Sim
from safety_monitor import Monitor, Violation, body_row, settings_of

from hil_sim.core.library import library, sonars_of

WITHIN_MS: Final = 150
"""Between a SIP and its answer: both in one turn of argusd's loop, but the host may be busy."""
_HEALTH: Final = {
    "SONAR_DISABLED": ("DISABLED", ""),
    "SONAR_STALE": ("STALE", ""),
    "SONAR_PROBATION": ("PROBATION", ""),
    "SONAR_SUSPECT": ("SUSPECT", ""),
    "SONAR_NAMED": ("SUSPECT", "named"),
    "SONAR_CLEARED": ("HEALTHY", ""),
    "SONAR_HEALTHY": ("HEALTHY", ""),
}


class Fact(NamedTuple):
    """Something that happened, at a wall clock; of one time first what comes first in `order`."""

    unix_s: float
    order: int
    what: str
    about: Any


def on_the_wire(recording: Path) -> Iterator[Fact]:
    """Bytes that argusd read and wrote."""
    for chunk in open_log(str(recording)):
        if chunk.t is not None:
            yield Fact(chunk.t, 1, chunk.dir, bytes(chunk.data))


def of_argusd(argusd: Argusd) -> Iterator[Fact]:
    """What it says of its sonars counts for what it sends in the same turn; other events come after that."""
    offset_s = min((e["unix"] - e["t"] for e in argusd.named("STATUS") if "t" in e), default=0.0)
    for event in argusd.events:
        if "t" not in event:
            continue
        unix_s = float(event["t"] + offset_s)
        if event["event"] == "STATUS":
            yield Fact(unix_s, 0, "status", event)
        elif event["event"] in _HEALTH and event["name"].startswith("sonar/"):
            yield Fact(unix_s - 0.002, 0, "health", event)
        else:
            yield Fact(unix_s + 0.001, 2, "event", event)


def of_robot(sim: Sim, until_unix_s: float) -> Iterator[Fact]:
    """Where the robot really is, as long as this argusd is the one that speaks to it."""
    for clock in sim.of("clock"):
        offset_s = float(clock["unix_s"] - clock["t_s"])
        for record in sim.of("state") + sim.of("collision"):
            if record["t_s"] + offset_s < until_unix_s:
                yield Fact(float(record["t_s"]) + offset_s, 1, str(record["type"]), record)


class Watch:
    """The monitor, and what it needs to remember of the facts."""

    def __init__(self, config: dict[str, Any], from_unix_s: float) -> None:
        known = {"sonars": sonars_of(library()), "within_ms": WITHIN_MS}
        if "robot" in config:
            known["body"] = body_row(config["robot"])
        self.monitor = Monitor(**(settings_of(config, baud=BAUD) | known))
        self._from_unix_s = from_unix_s
        self._states = [("UNKNOWN", "")] * known["sonars"]
        self._moves = (0.0, 0.0)

    def _health(self, states: Iterable[tuple[int, tuple[str, str]]]) -> None:
        for number, state in states:
            self._states[number] = state
        self.monitor.health(self._states)

    def _truth(self, t_ms: float, record: Record) -> None:
        if record["type"] == "collision":
            self.monitor.truth(t_ms, *self._moves, 0.0, contact=True)
        else:
            self._moves = float(record["v_mm_s"]), float(record["w_deg_s"])
            self.monitor.truth(t_ms, *self._moves, float(record["clearance_mm"]), contact=False)

    def take(self, fact: Fact) -> None:
        """Tell it to the monitor."""
        t_ms = (fact.unix_s - self._from_unix_s) * 1000
        about = fact.about
        if fact.what == CLIENT_TO_ROBOT:
            self.monitor.to_robot(t_ms, about)
        elif fact.what == "status":
            self._health(enumerate(zip(about["health"], about["kind"], strict=True)))
        elif fact.what == "health":
            self._health([(int(about["name"].rsplit("/")[-1]), _HEALTH[about["event"]])])
        elif fact.what == "event":
            self.monitor.event(t_ms, int(about["id"]), int(about.get("value", 0)))
        elif fact.what in ("state", "collision"):
            self._truth(t_ms, about)
        else:
            self.monitor.from_robot(t_ms, about)


def facts_of(sim: Sim, argusd: Argusd, recording: Path, until_unix_s: float) -> list[Fact]:
    """All that happened in a drive, in its order."""
    facts = [*on_the_wire(recording), *of_argusd(argusd), *of_robot(sim, until_unix_s)]
    return sorted(facts, key=lambda fact: (fact.unix_s, fact.order))


def watch(facts: Iterable[Fact], config: dict[str, Any]) -> list[Violation]:
    """Return what the monitor finds in it."""
    watching: Watch | None = None
    for fact in facts:
        watching = watching or Watch(config, fact.unix_s - 1.0)
        watching.take(fact)
    return watching.monitor.violations if watching is not None else []


def breaches(bench: Bench) -> list[str]:
    """All that each argusd of a bench with one robot did against S1 to S8."""
    starts = [daemon.started_unix_s for daemon in bench.daemons]
    found: list[str] = []
    for at, daemon in enumerate(bench.daemons):
        recording, config = bench.recordings[at], bench.configs[at]
        until = min((start for start in starts if start > starts[at]), default=float("inf"))
        if recording.exists():
            facts = facts_of(bench.sims[0], daemon, recording, until)
            found += [f"argusd {at}: {one}" for one in watch(facts, config)]
    return found
