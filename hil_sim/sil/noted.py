# SPDX-License-Identifier: MIT
"""The robot and its faults, with what happens to them noted."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Final

import numpy as np

from hil_sim.faults.execute import FaultSet
from hil_sim.faults.kinds import FaultChange
from hil_sim.robot.interfaces import SonarReading
from hil_sim.robot.robot import Robot
from hil_sim.robot.ticks import Ticks
from hil_sim.sil.outcome import Collision, FaultTruth
from hil_sim.sonar.ring import SonarRing
from hil_sim.world.model import Pose

VISIBLE_MM: Final = 100.0
VISIBLE_PART: Final = 0.05
"""A fault shows in a reading that is off by more than the larger of VISIBLE_MM and this part of the truth."""


class NotedRobot(Robot):
    """The robot, with its SIPs and its collisions noted.

    watch: called after each sub-step with the readings that came in it.
    """

    noted: tuple[SonarReading, ...] = ()
    watch: Callable[[Sequence[SonarReading]], None] | None = None

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.hits: list[Collision] = []
        self._news: list[SonarReading] = []

    def step(self) -> None:
        """Let one sub-step pass, and tell the watcher."""
        super().step()
        if self.watch is not None:
            news, self._news = self._news, []
            self.watch(news)

    def _in_c(self) -> Ticks | None:
        return super()._in_c() if self.watch is None else None

    def _hear(self, readings: Sequence[SonarReading]) -> None:
        super()._hear(readings)
        if self.watch is not None:
            self._news += readings

    def take_readings(self) -> list[SonarReading]:
        """Return the readings that go into a SIP, and note them."""
        readings = super().take_readings()
        self.noted = tuple(readings)
        return readings

    @property
    def kinds(self) -> list[str | None]:
        """Kinds of faults by the numbers that C writes; it grows with each new one."""
        return self.ring.kinds if isinstance(self.ring, SonarRing) else [None]

    def _hit(self, moved_in: bool) -> None:
        super()._hit(moved_in)
        self.hits.append(Collision(self.now_ms / 1000, self.chassis.x, self.chassis.y, moved_in))


class NotedFaults(FaultSet):
    """The injected faults, with what they did to each sonar noted."""

    travelled_mm = 0.0

    def __init__(self, faults: Sequence[Any], rng: np.random.Generator) -> None:
        super().__init__(faults, rng)
        self.truth: list[FaultTruth] = []
        self._open: dict[tuple[str, int], FaultTruth] = {}

    def update(self, now_ms: float, pose: Pose, travelled_mm: float) -> list[FaultChange]:
        """Begin and end faults, and note it."""
        self.travelled_mm = travelled_mm
        changes = super().update(now_ms, pose, travelled_mm)
        for change in changes:
            if change.sonar is not None:
                self._note(change, change.sonar)
        return changes

    def _note(self, change: FaultChange, sonar: int) -> None:
        if change.on:
            truth = FaultTruth(change.kind, sonar, change.text, change.t_ms / 1000, self.travelled_mm)
            self._open[change.text, sonar] = truth
            self.truth.append(truth)
        else:
            # Of a fault that is written twice the first end counts.
            key = change.text, sonar
            if key in self._open:
                self._open.pop(key).end_s = change.t_ms / 1000

    def note_ping(self, t_ms: float, number: int, true_mm: int, heard_mm: int, value: int | None) -> None:
        """Note the first reading in which the fault shows."""
        fault = self.active(number)
        truth = self._open.get((fault.text, number)) if fault is not None else None
        if truth is None or truth.first_visible_s is not None:
            return
        if value is not None:
            limit = max(VISIBLE_MM, VISIBLE_PART * true_mm)
            if abs(value - true_mm) <= limit or abs(value - heard_mm) <= limit:
                return
        truth.first_visible_s = t_ms / 1000
        truth.first_visible_driven_mm = self.travelled_mm
