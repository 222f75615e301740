# SPDX-License-Identifier: MIT
"""What a drive shows while it runs: a screen on a terminal, else one line per event and one each few seconds."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from typing import Any, Final, Protocol

from rich.console import Console, Group
from rich.live import Live
from rich.panel import Panel
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from hil_sim.demo.judge import Record, event_s, of_type
from hil_sim.demo.runner import Recording
from hil_sim.faults.values import value_words
from hil_sim.tables.robot import robot_table

STATUS_EVERY_S: Final = 5.0
_EVENTS_SHOWN: Final = 8
_QUIET: Final = frozenset({"STATUS", "SONAR_HEALTHY", "STOPPED", "SONAR_WITNESS", "PLAN_ROTATION"})
_LEVEL: Final = ("OK   ", "WARN ", "ERROR", "STALE")
_LEVEL_STYLE: Final = ("", "yellow", "bold red", "magenta")
_HEALTH_STYLE: Final = {"HEALTHY": "green", "SUSPECT": "yellow", "DISABLED": "bold red", "STALE": "magenta"}
_POSES: Final[Mapping[int, int]] = {
    number: int(mount.heading_deg) for number, mount in enumerate(robot_table().mounts)
}


class View(Protocol):
    """Told of every change of the recording; closed at the end."""

    def show(self, recording: Recording) -> None:
        """Take what is new."""

    def close(self) -> None:
        """Give the terminal back."""


def event_line(event: Record) -> str:
    """One event for people."""
    level = _LEVEL[min(int(event.get("level", 0)), 3)]
    shown = value_words(str(event.get("event", "")), int(event.get("value") or 0))
    return f"{event_s(event):8.2f} s  {level} {event.get('name', ''):<15} {event.get('event', '')}{shown}"


def fault_line(record: Record) -> str:
    """One fault's onset or end in the emulator, for people."""
    what = "INJECTED" if record.get("active") else "ENDED"
    sonars = ", ".join(str(sonar) for sonar in record.get("sonars", ()))
    return f"{record['t_s']:8.2f} s  ----- emulator        {what}: sonar {sonars} {record.get('kind')}"


def status_line(status: Record, journey_s: float) -> str:
    """Readings, failure state, plan and progress on one line."""
    front = " ".join(f"{mm}{'!' if health == 'DISABLED' else ''}" for mm, health in _front(status))
    plan = " ".join(f"{angle:+d}" for angle in status.get("plan_deg", ())) or "none"
    return (
        f"{journey_s:8.2f} s  {status.get('mode', ''):<9} {status.get('state', ''):<14} "
        f"goal {status.get('goal_mm', 0) / 1000:.2f} m  plan {plan}  front {front}"
    )


def _front(status: Record) -> list[tuple[int, str]]:
    return list(zip(status.get("reading_mm", ())[:8], status.get("health", ())[:8], strict=False))


class Lines:
    """For pipes and files: plain lines."""

    def __init__(self) -> None:
        self._events = 0
        self._truth = 0
        self._said_s = -STATUS_EVERY_S
        self._status: Record | None = None

    def show(self, recording: Recording) -> None:
        """Print what is new."""
        for record in of_type(recording.truth[self._truth :], "fault"):
            print(fault_line(record))
        self._truth = len(recording.truth)
        for event in recording.events[self._events :]:
            if event.get("event") == "STATUS":
                self._status = event
            if event.get("event") not in _QUIET:
                print(event_line(event))
        self._events = len(recording.events)
        if self._status is not None and recording.journey_s - self._said_s >= STATUS_EVERY_S:
            self._said_s = recording.journey_s
            print(status_line(self._status, recording.journey_s))
        sys.stdout.flush()

    def close(self) -> None:
        """Nothing to give back."""


class Screen:
    """For a terminal: readings front and rear, health, failure state, plan, progress, events."""

    def __init__(self, console: Console) -> None:
        self._live = Live(console=console, refresh_per_second=8, transient=True)
        self._live.start()
        self._events = 0
        self._truth = 0
        self._status: Record = {}
        self._log: list[Text] = []

    def show(self, recording: Recording) -> None:
        """Redraw with what is new."""
        for record in of_type(recording.truth[self._truth :], "fault"):
            self._log.append(Text(fault_line(record), style="bold cyan"))
        self._truth = len(recording.truth)
        for event in recording.events[self._events :]:
            if event.get("event") == "STATUS":
                self._status = event
            elif event.get("event") not in _QUIET:
                style = _LEVEL_STYLE[min(int(event.get("level", 0)), 3)]
                self._log.append(Text(event_line(event), style=style))
        self._events = len(recording.events)
        self._log = self._log[-_EVENTS_SHOWN:]
        self._live.update(self._picture(recording))

    def close(self) -> None:
        """Leave the terminal as it was."""
        self._live.stop()

    def _picture(self, recording: Recording) -> Panel:
        status = self._status
        course = max(float(status.get("course_mm", 0)), 1.0)
        done = max(0.0, course - float(status.get("goal_mm", course)))
        plan = " ".join(f"{angle:+d}" for angle in status.get("plan_deg", ())) or "none"
        head = Text.assemble(
            (f"{recording.journey_s:6.1f} s   ", "bold"),
            (f"{status.get('mode', 'starting'):<10}", "bold"),
            (
                f"{status.get('state', ''):<16}",
                "bold red" if status.get("state", "IsNormal") != "IsNormal" else "green",
            ),
            f"plan (deg): {plan}",
        )
        progress = Table.grid(padding=(0, 1))
        progress.add_row(
            f"goal {status.get('goal_mm', 0) / 1000:5.2f} m",
            ProgressBar(total=course, completed=done, width=50),
        )
        return Panel(
            Group(head, progress, _sonars(status), *self._log),
            title="Argus",
            subtitle="Ctrl-C stops both programs",
        )


def _sonars(status: Record) -> Table:
    table = Table(box=None, padding=(0, 1))
    for title in ("front", "looks", "mm", "health", "", "rear", "looks", "mm", "health"):
        table.add_column(title, justify="left" if title == "health" else "right")
    for front in range(8):
        table.add_row(*_sonar_cells(status, front), "", *_sonar_cells(status, front + 8))
    return table


def _sonar_cells(status: Record, sonar: int) -> Sequence[Text]:
    readings: Sequence[Any] = status.get("reading_mm", ())
    if sonar >= len(readings):
        return [Text(str(sonar)), Text(f"{_POSES[sonar]:+d}"), Text("-"), Text("")]
    health, kind = str(status["health"][sonar]), str(status["kind"][sonar])
    shown = f"{health} ({kind})" if kind else health
    style = _HEALTH_STYLE.get(health, "")
    return [
        Text(str(sonar)),
        Text(f"{_POSES[sonar]:+d}"),
        Text(str(readings[sonar])),
        Text(shown, style=style),
    ]


def view(live: bool) -> View:
    """The screen where standard output is a terminal and it is wanted, else lines."""
    console = Console()
    able = console.is_terminal and not console.is_dumb_terminal
    return Screen(console) if live and able else Lines()
