# SPDX-License-Identifier: MIT
"""Ranges of any robot, judged as they come: pose, speeds and ranges in, events and the health of each sonar out.

>>> watch = Observer("amigo-sh")
>>> events = watch.observe(0.0, (0, 0, 0), (200, 0), [700, 900, 1500, 1500, 900, 700, 3000, 3000])
>>> [event.event for event in events][:2]
['LINK_UP', 'SESSION_OPEN']
>>> watch.kind
['', '', '', '', '', '', '', '']
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

from hil_sim.core.library import Core, CoreEvent, setting_value
from hil_sim.errors import InputError
from hil_sim.tables.robot import DEFAULT_ROBOT, robot_table

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["CoreEvent", "InputError", "Observer"]

_OLD_MS: Final = 250
_FAR: Final = 2**31 - 1


class Observer:
    """A fault manager that only listens, over a ring of a known robot or of FILE.toml.

    Lengths are mm, angles radians, times seconds of any clock; sequences may be numpy arrays.
    """

    def __init__(self, robot: str = DEFAULT_ROBOT, config: Mapping[str, int | str] | None = None) -> None:
        self._table = robot_table(robot)
        given = {key: setting_value(key, str(value)) for key, value in (config or {}).items()}
        if self._table.ring is None:
            given["robot"] = setting_value("robot", self._table.subclass)
        self._core = Core(0, {**given, "active": 0}, self._table.ring)
        self._core.link_up(0)
        self._begin_s: float | None = None
        self._now_ms = 0

    def observe(
        self,
        t_s: float,
        pose: Sequence[float] | NDArray[Any],
        speeds: Sequence[float] | NDArray[Any],
        ranges: Sequence[float] | NDArray[Any],
        ages_s: Sequence[float] | NDArray[Any] | None = None,
    ) -> list[CoreEvent]:
        """Take one time; return what is said. InputError for what does not hold.

        pose: x, y, heading. speeds: ahead, and the turn. ranges: one of each sonar; NaN is none since the last call,
        infinite no echo. ages_s: of each range; those above a quarter of a second are left out.
        """
        if len(ranges) != self._table.sonars:
            raise InputError(
                f"{len(ranges)} ranges of the {self._table.sonars} sonars of {self._table.subclass}"
            )
        motion = (*map(float, pose), *map(float, speeds))
        if len(motion) != 5 or not all(map(math.isfinite, (t_s, *motion))):
            raise InputError("give finite times, a pose x, y, heading, and speeds ahead and of the turn")
        self._advance(float(t_s))
        ages = ages_s if ages_s is not None else [0.0] * len(ranges)
        readings = [
            (sonar, self._millimetres(float(range_mm)), round(float(age_s) * 1000))
            for sonar, (range_mm, age_s) in enumerate(zip(ranges, ages, strict=True))
            if not math.isnan(range_mm) and 0 <= age_s * 1000 <= _OLD_MS
        ]
        x, y, heading, speed, turn = motion
        angle = math.remainder(heading, math.tau)
        cdeg = (math.degrees(angle) * 100, math.degrees(turn) * 100)
        whole = [round(max(-_FAR, min(_FAR, value))) for value in (x, y, cdeg[0], speed, cdeg[1])]
        self._core.observe(self._now_ms, (whole[0], whole[1], whole[2], whole[3], whole[4]), readings)
        self._core.process(self._now_ms)
        return list(self._core.events())

    def _millimetres(self, range_mm: float) -> int:
        return round(max(0.0, min(range_mm, float(self._table.no_echo_mm))))

    def _advance(self, t_s: float) -> None:
        if self._begin_s is None:
            self._begin_s = t_s
        until_ms = round((t_s - self._begin_s) * 1000)
        if until_ms < self._now_ms:
            raise InputError(f"{t_s} s is before the last time")
        while self._now_ms < until_ms:
            self._now_ms = min(self._now_ms + max(1, self._core.process(self._now_ms)), until_ms)

    @property
    def health(self) -> list[str]:
        """The health of each sonar: HEALTHY, SUSPECT and so on."""
        return list(self._core.status()["health"][: self._table.sonars])

    @property
    def kind(self) -> list[str]:
        """The kind of fault of each sonar, empty for none: only those without one are to be used."""
        return list(self._core.status()["kind"][: self._table.sonars])
