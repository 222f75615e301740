# SPDX-License-Identifier: MIT
"""The fault manager, fed with ranges of any origin: they become packets of a robot that is made up around them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Final

from argus_tools.log.opening import opened
from argus_tools.rings.intake import Limits
from argus_tools.rings.motion import Motion
from argus_tools.rings.packet import empty, identity_of, packet

from argus_ros.repair import Verdict
from hil_sim.arcos import TIMING
from hil_sim.core.library import Core, CoreEvent
from hil_sim.tables.robot import RobotTable

_SIP_MS: Final = TIMING["SIP_CYCLE_MS"]
_STEP_MS: Final = 10
_GAP_MS: Final = 5_000
_ORDER_MS: Final = 1_000
_MM: Final = 1000


class Ring:
    """A passive fault manager over a ring of sonars.

    Times are seconds of one clock, those of the messages: a replay at any speed gives the same verdicts.
    """

    def __init__(self, table: RobotTable, settings: Mapping[str, int] | None = None) -> None:
        self._table = table
        self._no_echo_mm = table.no_echo_mm
        self._least_mm = table.min_mm
        self._settings = {**(settings or {}), "active": 0}
        self.motion = Motion()
        self._fresh: dict[int, int] = {}
        self._noted: dict[int, int] = {}
        self._core: Core | None = None
        self._origin_s = 0.0
        self._now_ms = 0
        self._sip_ms = 0
        self._verdicts: list[Verdict] = [Verdict()] * table.sonars
        self._said: list[CoreEvent] = []
        self.restarts = 0
        self.failure = "IsNormal"
        self._opened()  # settings that do not hold are refused now, not at the first message
        self._said.clear()

    @property
    def verdicts(self) -> list[Verdict]:
        """What is said of each sonar."""
        return self._verdicts

    def note(self, sonar: int, range_m: float, limits: Limits) -> None:
        """Take a reading of a sonar, at the time to which the ring advances next; NaN is none."""
        if not math.isnan(range_m):
            self._noted[sonar] = self._millimetres(range_m, limits)

    def _millimetres(self, range_m: float, limits: Limits) -> int:
        if range_m >= limits.greatest_m:
            return self._no_echo_mm
        if range_m == -math.inf:
            return self._least_mm
        return min(max(0, round(range_m * _MM)), self._no_echo_mm - 1)

    def advance(self, t_s: float) -> bool:
        """Let time pass up to that of a message; a jump of the clock begins anew. True: a packet was made."""
        if self._core is not None:
            ahead_ms = (t_s - self._origin_s) * 1000 - self._now_ms
            if not -_ORDER_MS <= ahead_ms <= _GAP_MS:
                self._core = None
                self.restarts += 1
        if self._core is None:
            self._core = self._opened()
            self._fresh.clear()  # readings of another clock
            self._origin_s = t_s - self._now_ms / 1000
        self._fresh |= self._noted
        self._noted.clear()
        until_ms, before_ms = int((t_s - self._origin_s) * 1000), self._sip_ms
        while self._now_ms < until_ms:
            self._pass(self._core, min(self._now_ms + _STEP_MS, until_ms))
        return self._sip_ms != before_ms

    def _pass(self, core: Core, now_ms: int) -> None:
        self._now_ms = now_ms
        is_due = now_ms - self._sip_ms >= _SIP_MS
        if is_due:
            self._sip_ms += _SIP_MS
            core.receive(now_ms, self._sip())
        core.process(now_ms)
        core.transmit()
        self._said += core.events()
        if is_due:
            status = core.status()
            self._verdicts = [Verdict(*pair) for pair in zip(status["health"], status["kind"], strict=True)]
            self.failure = str(status["failure"])

    def events(self) -> Iterator[CoreEvent]:
        """Yield what was said since the last call."""
        said, self._said = self._said, []
        yield from said

    def _opened(self) -> Core:
        """Return a manager in a session with a robot that has reported nothing yet."""
        core, now_ms = opened(self._settings, identity_of(self._table), empty().data)
        self._now_ms = self._sip_ms = now_ms
        self._verdicts = [Verdict()] * self._table.sonars
        self._said += core.events()
        return core

    def _sip(self) -> bytes:
        fresh, self._fresh = self._fresh, {}
        return packet(self._table, self.motion, fresh)
