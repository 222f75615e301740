# SPDX-License-Identifier: MIT
"""The fault manager, fed with ranges of any origin: they become packets of a robot that is made up around them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Final

from argus_tools.core import Core, Event
from argus_tools.log.opening import opened

from argus_ros.motion import Motion
from argus_ros.repair import Limits, Verdict
from hil_sim.arcos import FLAG, TIMING, Sip, SyncReply, frame
from hil_sim.tables import load
from hil_sim.tables.robot import RobotTable

_SIP_MS: Final = TIMING["SIP_CYCLE_MS"]
_STEP_MS: Final = 10
_GAP_MS: Final = 5_000
_ORDER_MS: Final = 1_000
_WORD: Final = 0xFFFF
_MM: Final = 1000
_FLAGS: Final = FLAG["MOTORS"] | FLAG["SONAR1"] | FLAG["SONAR2"]


class Ring:
    """A passive fault manager over a ring of sonars.

    Times are seconds of one clock, those of the messages: a replay at any speed gives the same verdicts.
    """

    def __init__(self, table: RobotTable, settings: Mapping[str, int] | None = None) -> None:
        sonar = load(f"robots/{table.subclass}")["sonar"]
        self._table = table
        self._no_echo_mm: int = sonar["no_echo_mm"]
        self._least_mm: int = sonar["min_mm"]
        self._settings = {**(settings or {}), "active": 0}
        self.motion = Motion()
        self._fresh: dict[int, int] = {}
        self._core: Core | None = None
        self._origin_s = 0.0
        self._now_ms = 0
        self._sip_ms = 0
        self._verdicts: list[Verdict] = [Verdict()] * table.sonars
        self._said: list[Event] = []
        self.restarts = 0
        self.failure = "IsNormal"
        self._opened()  # settings that do not hold are refused now, not at the first message
        self._said.clear()

    @property
    def verdicts(self) -> list[Verdict]:
        """What is said of each sonar."""
        return self._verdicts

    def note(self, sonar: int, range_m: float, limits: Limits) -> None:
        """Take a reading of a sonar; NaN is none."""
        if not math.isnan(range_m):
            self._fresh[sonar] = self._millimetres(range_m, limits)

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
            self._origin_s = t_s - self._now_ms / 1000
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

    def events(self) -> Iterator[Event]:
        """Yield what was said since the last call."""
        said, self._said = self._said, []
        yield from said

    def _opened(self) -> Core:
        """Return a manager in a session with a robot that has reported nothing yet."""
        identity = SyncReply(b"", self._table.robot_class.encode(), self._table.subclass.encode())
        core, now_ms = opened(self._settings, identity, Sip(flags=_FLAGS).data)
        self._now_ms = self._sip_ms = now_ms
        self._verdicts = [Verdict()] * self._table.sonars
        self._said += core.events()
        return core

    def _sip(self) -> bytes:
        fresh, self._fresh = self._fresh, {}
        motion, odometry = self.motion, self._table.odometry
        unit_mm = odometry["dist_conv_um"] / 1000
        speed_unit = odometry["vel_conv_um_s"] / 1000
        range_unit = odometry["range_conv_um"] / 1000
        turn = odometry["angle_per_turn"]
        half_mm = self._table.motion["track_mm"] / 2
        speed, across = motion.speed_m_s * _MM, motion.turn_rad_s * half_mm
        return frame(
            Sip(
                x=round(motion.x_m * _MM / unit_mm) & _WORD,
                y=round(motion.y_m * _MM / unit_mm) & _WORD,
                th=round(motion.heading_rad / math.tau * turn) % turn,
                left_vel=round((speed - across) / speed_unit),
                right_vel=round((speed + across) / speed_unit),
                battery=120,
                flags=_FLAGS,
                sonars=tuple(
                    (number, round(mm / range_unit) & _WORD) for number, mm in sorted(fresh.items())
                ),
                battery_x10=120,
            ).data
        )
