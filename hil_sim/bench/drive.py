# SPDX-License-Identifier: MIT
"""Records drive-bys: the emulated robot follows its course by the truth, the fault manager only listens."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path
from typing import Final

import numpy as np

from hil_sim.bench.plan import Case, mission_of, parse_id, with_people
from hil_sim.bench.stream import Stream, stream_path
from hil_sim.bench.work import Record, failed, head
from hil_sim.robot.interfaces import SonarReading
from hil_sim.sil import Mission, Sighting, Sil
from hil_sim.sonar.ring import SonarRing

SPEED_MM_S: Final = 200.0
FAULT_LIMIT_S: Final = 120.0
FREE_LIMIT_S: Final = 300.0
AFTER_S: Final = 42.0
"""A stream ends so long after the fault has shown first: the bounds are 30 s at most."""
_STEER_MS: Final = 100.0
_REACHED_MM: Final = 60.0
_PASSED_MM, _PASSED_DEG = 300.0, 60.0
_AIMED_DEG, _AIMED_DEG_S = 2.0, 8.0
_TURN_GAIN, _TURN_MOST_DEG_S = 1.6, 45.0
_KEEP_GAIN, _KEEP_MOST_DEG_S = 1.0, 20.0
_SLOWEST_MM_S: Final = 40.0
_ACCEL_MM_S2, _TURN_ACCEL_DEG_S2 = 300, 100
_NEAR_MM: Final = 420.0
_AHEAD: Final = (2, 3, 4, 5)
_WAIT_S, _GIVE_UP_S = 12.0, 15.0


class DriveBy(Sil):
    """One mission whose course the robot follows from point to point, round and round, by its true pose.

    It waits for people who stand in its way, and after a while goes on to the next point.
    """

    def __init__(
        self, mission: Mission, course: tuple[tuple[float, float], ...], speed_mm_s: float = SPEED_MM_S
    ) -> None:
        self.speed_mm_s = speed_mm_s
        self.rows: list[tuple[int, int, int, int, int]] = []
        super().__init__(mission, trace=_note)
        self.traffic = []
        self.robot.watchdog_stops = False
        self._course, self._leg, self._turning = course, 0, True
        self._steer_ms, self._waited_s = 0.0, 0.0

    @property
    def driving_s(self) -> float:
        """Time in motion so far."""
        return self._driving_ms / 1000

    def _turn(self, now_ms: float) -> None:
        super()._turn(now_ms)
        if now_ms >= self._steer_ms and self.robot.connected:
            self._steer_ms = now_ms + _STEER_MS
            self._steer()

    def _steer(self) -> None:
        drive = self.robot.drive
        if not drive.motors:
            self._begin()
        away_mm, off_deg = self._aim()
        passed = not self._turning and away_mm < _PASSED_MM and abs(off_deg) > _PASSED_DEG
        if away_mm < _REACHED_MM or passed:
            self._next_leg()
            speed, rate = 0.0, 0.0
        elif self._turning and (abs(off_deg) >= _AIMED_DEG or abs(drive.w) >= _AIMED_DEG_S):
            speed, rate = 0.0, _bounded(_TURN_GAIN * off_deg, _TURN_MOST_DEG_S)
        else:
            self._turning = False
            speed = self._speed(away_mm)
            rate = _bounded(_KEEP_GAIN * off_deg, _KEEP_MOST_DEG_S) if speed else 0.0
        drive.vel(speed)
        drive.rvel(rate)

    def _begin(self) -> None:
        self.robot.enable(True)
        for sign in (1, -1):
            self.robot.drive.set_accel(sign * _ACCEL_MM_S2)
            self.robot.drive.set_turn_accel(sign * _TURN_ACCEL_DEG_S2)

    def _aim(self) -> tuple[float, float]:
        """How far the next point is, and how much to the left of the heading."""
        pose, (x, y) = self.robot.pose, self._course[self._leg]
        dx, dy = x - pose.x_mm, y - pose.y_mm
        off_deg = (math.degrees(math.atan2(dy, dx)) - pose.heading_deg + 180) % 360 - 180
        return math.hypot(dx, dy), off_deg

    def _next_leg(self) -> None:
        self._leg, self._turning = (self._leg + 1) % len(self._course), True

    def _speed(self, away_mm: float) -> float:
        speed = min(self.speed_mm_s, max(_SLOWEST_MM_S, away_mm))
        if self.mission.movers and self._nearest_ahead_mm() < _NEAR_MM * self.speed_mm_s / SPEED_MM_S:
            self._waited_s += _STEER_MS / 1000
            if self._waited_s > _GIVE_UP_S:
                self._waited_s = 0.0
                self._next_leg()
            return 0.0 if self._waited_s < _WAIT_S else speed
        return speed

    def _nearest_ahead_mm(self) -> float:
        ring = self.robot.ring
        assert isinstance(ring, SonarRing)
        return min(ring.true_range(number, self.robot.pose) for number in _AHEAD)

    def stream(self, case: Case) -> Stream:
        """Return what was recorded so far."""
        packets = [packet for packet in self.traffic or () if not packet.to_robot]
        return Stream(
            id=case.id,
            times_ms=np.array([int(packet.t_ms) for packet in packets], dtype=np.uint32),
            lengths=np.array([len(packet.data) for packet in packets], dtype=np.uint16),
            data=b"".join(packet.data for packet in packets),
            readings=np.array(self.rows, dtype=np.int32).reshape(-1, 5),
            truth=tuple(self._faults.truth) if self._faults is not None else (),
            people=bool(self.mission.movers),
            place=case.place,
            driving_s=self.driving_s,
            end_s=self.now_ms / 1000,
        )

    @property
    def has_shown(self) -> bool:
        """All faults have shown for as long as a stream goes on after that."""
        truth = self._faults.truth if self._faults is not None else []
        first = [fault.first_visible_s for fault in truth]
        return bool(first) and all(t is not None and self.now_ms / 1000 >= t + AFTER_S for t in first)


def _bounded(value: float, most: float) -> float:
    return max(-most, min(most, value))


def _row(reading: SonarReading) -> tuple[int, int, int, int, int]:
    faulty = int(reading.fault is not None)
    return reading.number, reading.range_mm, reading.true_mm, faulty, round(reading.t_ms)


def _note(sil: Sil, sighting: Sighting) -> None:
    assert isinstance(sil, DriveBy)
    sil.rows += map(_row, sighting.readings)


def _unrepaired(text: str) -> str:
    """The same fault without an end: a stream is over before."""
    head_, _, when = text.partition("@")
    return f"{head_}@{_cut_end(when)}"


def _cut_end(when: str) -> str:
    start, _, parameter = when.partition(":")
    return start.partition("-")[0] + (f":{parameter}" if parameter else "")


def record(case: Case, physics: str = "", *, people: bool = False, speed_mm_s: float = SPEED_MM_S) -> Stream:
    """Drive one case and return its stream. people: also where the case has none."""
    planned = with_people(case) if people else mission_of(case)
    free = case.kind == "free"
    mission = dataclasses.replace(
        planned,
        course=(),
        faults=tuple(_unrepaired(text) for text in planned.faults),
        config={**planned.config, "active": "off"},
        limit_s=FREE_LIMIT_S if free else FAULT_LIMIT_S,
        stop_at_goal=False,
        physics=physics,
    )
    sil = DriveBy(mission, planned.course, speed_mm_s)
    while not sil.over and not sil.has_shown:
        sil.run_until(min(mission.limit_s, sil.now_ms / 1000 + 1))
    return sil.stream(case)


def record_to(
    case_id: str, folder: str, physics: str, people: bool = False, speed_mm_s: float = SPEED_MM_S
) -> Record:
    """Record the case of an id into a folder; never raises: `error` tells what went wrong."""
    case = parse_id(case_id)
    try:
        stream = record(case, physics, people=people, speed_mm_s=speed_mm_s)
        stream.save(stream_path(Path(folder), case_id))
    except Exception as error:  # whatever a mission does, the others must run
        return failed(case, f"{type(error).__name__}: {error}")
    return head(case)
