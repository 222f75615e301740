# SPDX-License-Identifier: MIT
"""A mission of the SIL that the monitor of the safety rules watches: the wire at the manager, and the truth."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, cast

from safety_monitor import Monitor, Violation, settings_of

from hil_sim.core.library import Core, CoreEvent, health_name, kind_name, library, sonars_of
from hil_sim.sil import Mission, Sil

_HEAD = 2


class WatchedCore:
    """The fault manager, with the monitor on its wire; all else is the fault manager's own."""

    def __init__(self, core: Core, monitor: Monitor) -> None:
        self._core, self._monitor = core, monitor
        self._now = 0
        self._brief = b""

    def __getattr__(self, name: str) -> Any:
        return getattr(self._core, name)

    def receive(self, now_ms: int, data: bytes) -> None:
        self._now = now_ms
        self._monitor.from_robot(now_ms, data)
        self._core.receive(now_ms, data)

    def process(self, now_ms: int) -> int:
        self._now = now_ms
        return self._core.process(now_ms)

    def transmit(self) -> list[bytes]:
        # What it knows of the sonars when it decides counts for what it sends.
        brief = self._core.brief()
        if brief[_HEAD:] != self._brief:
            self._brief = brief[_HEAD:]
            managed = len(self._brief) // 2
            health, kind = self._brief[:managed], self._brief[managed:]
            self._monitor.health([(health_name(h), kind_name(k)) for h, k in zip(health, kind, strict=True)])
        packets = self._core.transmit()
        for packet in packets:
            self._monitor.to_robot(self._now, packet)
        return packets

    def events(self) -> Iterator[CoreEvent]:
        for event in self._core.events():
            self._monitor.event(self._now, event.id, event.value)
            yield event


class WatchedSil(Sil):
    """One mission, watched."""

    def __init__(self, mission: Mission, settings: Mapping[str, int] | None = None, **options: Any) -> None:
        given = {"sonars": sonars_of(library())} | settings_of(mission.config, baud=mission.baud)
        given |= dict(settings or {})
        self.monitor = Monitor(**given)
        self._hits = 0
        self._speeds = (0.0, 0.0)
        super().__init__(mission, **options)

    def _build_core(self) -> Core:
        return cast(Core, WatchedCore(super()._build_core(), self.monitor))

    def _look_at_robot(self, packet: bytes) -> None:
        super()._look_at_robot(packet)
        robot = self.robot
        contact = any(not hit.struck for hit in robot.hits[self._hits :])
        self._hits = len(robot.hits)
        now = robot.drive.v, robot.drive.w
        # A body that has met something may stand already: what counts is how it came there.
        v, w = self._speeds if contact else now
        self._speeds = now
        self.monitor.truth(self.now_ms, v, w, 0.0 if contact else robot.chassis.free_mm, contact)

    @property
    def violations(self) -> list[Violation]:
        """What the monitor has found so far."""
        self.monitor.tick(self.now_ms)
        return self.monitor.violations


def watch(mission: Mission, **settings: int) -> tuple[WatchedSil, list[Violation]]:
    """Run a mission to its end; return it and what the monitor found."""
    sil = WatchedSil(mission, settings)
    sil.run()
    return sil, sil.violations
