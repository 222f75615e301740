# SPDX-License-Identifier: MIT
"""What a page that comes later is told: the last of each kind of line, the events, the way and the echoes."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any, Final

from argus_tools.monitor.geometry import robot_of
from hil_sim.faults.values import value_words
from hil_sim.sonar.params import NO_ECHO_MM
from hil_sim.tables.robot import RobotTable

EVENTS_KEPT: Final = 200
PATH_KEPT: Final = 2000
ECHOES_KEPT: Final = 3000
PATH_STEP_MM: Final = 25.0
ECHO_STEP_MM: Final = 30.0
"""An echo is drawn again only where the robot has moved so far since that sonar's last one."""
FRESH_MS: Final = 150
SAME_RUN_S: Final = 1.0
"""Runs of argusd that began farther apart are two, also where the later one has run for longer."""

Message = dict[str, Any]


def kind_of(message: Mapping[str, Any]) -> str:
    """Which stream a line belongs to; empty for one that we do not know."""
    if message.get("event") == "STATUS":
        return "state"
    if "event" in message:
        return "event"
    for name in ("readings", "evidence", "lost"):
        if name in message:
            return name
    return ""


class Memory:
    """Grows with each line; bounded in everything."""

    def __init__(self) -> None:
        self.table: RobotTable = robot_of("")
        self._is_first = False
        self._clear()

    def _clear(self) -> None:
        self.last: dict[str, Message] = {}
        self.events: deque[Message] = deque(maxlen=EVENTS_KEPT)
        self.path: deque[tuple[int, int]] = deque(maxlen=PATH_KEPT)
        self.echoes: deque[tuple[int, int, int]] = deque(maxlen=ECHOES_KEPT)
        self.goal: list[int] | None = None
        self._seen_from: dict[int, tuple[float, float, float]] = {}

    def take(self, message: Message) -> list[Message]:
        """Take a line of argusd; return what pages are to be told besides it, before it."""
        kind = kind_of(message)
        told: list[Message] = []
        if kind == "state":
            if self._is_another(message):
                self._clear()  # argusd began anew, and with it time and place
                told.append({"anew": True})
            told += self._take_state(message)
        elif kind == "event":
            value = message.get("value")
            message["shown"] = value_words(message["event"], value) if isinstance(value, int) else ""
            self.events.append(message)
        elif kind == "readings":
            told += self._take_readings(message["readings"])
        if kind in ("state", "readings", "evidence"):
            self.last[kind] = message
        return told

    def reconnected(self) -> None:
        """The next state is of another connection, and may be of another run of argusd."""
        self._is_first = True

    def _is_another(self, state: Message) -> bool:
        """Whether a state is of another run than the last: its time went back, or began at another moment."""
        last, is_first = self.last.get("state"), self._is_first
        self._is_first = False
        if last is None:
            return False
        if state.get("t", 0) < last.get("t", 0):
            return True
        return is_first and abs(_began(state) - _began(last)) > SAME_RUN_S

    def _take_state(self, state: Message) -> list[Message]:
        told: list[Message] = []
        table = robot_of(str(state.get("subclass", "")))
        if table is not self.table:
            self.table = table
            told.append({"robot": None})
        here = int(state.get("x_mm", 0)), int(state.get("y_mm", 0))
        if not self.path or math.dist(self.path[-1], here) >= PATH_STEP_MM:
            self.path.append(here)
            told.append({"trail": {"path": [here], "echoes": []}})
        return told

    def _take_readings(self, readings: Mapping[str, Any]) -> list[Message]:
        state = self.last.get("state")
        if state is None:
            return []
        pose = _pose(state)
        fresh = [
            self._echo(number, pose, mm, _usable(state, number))
            for number, (mm, age_ms) in enumerate(zip(readings["mm"], readings["age_ms"], strict=False))
            if 0 <= age_ms <= FRESH_MS and 0 < mm < NO_ECHO_MM and number < self.table.sonars
        ]
        echoes = [echo for echo in fresh if echo is not None]
        self.echoes.extend(echoes)
        return [{"trail": {"path": [], "echoes": echoes}}] if echoes else []

    def _echo(
        self, number: int, pose: tuple[float, float, float], mm: float, usable: bool
    ) -> tuple[int, int, int] | None:
        """Where an echo lies: x, y, and whether its sonar is trusted; None for one that is drawn already."""
        last = self._seen_from.get(number)
        if last and math.dist(last[:2], pose[:2]) < ECHO_STEP_MM and abs(last[2] - pose[2]) < math.radians(2):
            return None
        self._seen_from[number] = pose
        mount = self.table.mounts[number]
        x, y, turn = pose
        axis = math.radians(mount.heading_deg)
        ahead = mount.x_mm + mm * math.cos(axis)
        left = mount.y_mm + mm * math.sin(axis)
        return (
            round(x + ahead * math.cos(turn) - left * math.sin(turn)),
            round(y + ahead * math.sin(turn) + left * math.cos(turn)),
            int(usable),
        )

    def story(self) -> list[Message]:
        """Return all that a page that comes now has missed."""
        trail = {"path": list(self.path), "echoes": list(self.echoes)}
        return [{"trail": trail}, {"goal": self.goal}, *self.events, *self.last.values()]


def _began(state: Mapping[str, Any]) -> float:
    """When a run began by the clock of its machine, s since 1970."""
    return float(state.get("unix", 0)) - float(state.get("t", 0))


def _pose(state: Mapping[str, Any]) -> tuple[float, float, float]:
    heading_deg = float(state.get("heading_cdeg", 0)) / 100
    return float(state.get("x_mm", 0)), float(state.get("y_mm", 0)), math.radians(heading_deg)


def _usable(state: Mapping[str, Any], number: int) -> bool:
    kinds: Sequence[str] = state.get("kind", ())
    health: Sequence[str] = state.get("health", ())
    return (
        number < len(kinds)
        and number < len(health)
        and not kinds[number]
        and health[number] in ("HEALTHY", "UNKNOWN")
    )
