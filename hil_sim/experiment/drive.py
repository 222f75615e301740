# SPDX-License-Identifier: MIT
"""One journey of the study from its case to its record."""

from __future__ import annotations

import math
import traceback
from collections.abc import Sequence
from typing import Any, Final

from hil_sim.experiment.cases import Case, course_mm, mission_of, parse_id
from hil_sim.experiment.safety import Safety
from hil_sim.robot.interfaces import SonarReading
from hil_sim.sil import Outcome, Sil

RECORD_FORMAT: Final = "experiment 1"
"""Raised whenever a record gets another field: results of two formats do not mix."""
_RUNS_MM_S, _RESTS_MM_S = 50.0, 5.0
_ON_PATH_MM: Final = 100.0

Record = dict[str, Any]


class Diary:
    """What is noted of a journey at every tick, with the rules of safety asked as well."""

    def __init__(self, sil: Sil) -> None:
        self._sil = sil
        self.safety = Safety(sil)
        self.turned_deg = 0.0
        self.stops: list[tuple[int, int]] = []
        self.path: list[tuple[int, int]] = []
        self._th = sil.robot.chassis.th
        self._runs = False
        sil.robot.watch = self._tick

    def _tick(self, news: Sequence[SonarReading]) -> None:
        self.safety.tick(news)
        chassis = self._sil.robot.chassis
        self.turned_deg += abs(chassis.th - self._th)
        self._th = chassis.th
        speed = abs(self._sil.robot.drive.v)
        spot = round(chassis.x), round(chassis.y)
        if not self.path or math.dist(self.path[-1], spot) >= _ON_PATH_MM:
            self.path.append(spot)
        if self._runs and speed <= _RESTS_MM_S:
            self.stops.append(spot)
            self._runs = False
        self._runs = self._runs or speed > _RUNS_MM_S


def run_case(case: Case) -> tuple[Record, Outcome, Diary]:
    """Run a case; return its record and, for callers that want more, all that came of it."""
    sil = Sil(mission_of(case))
    diary = Diary(sil)
    outcome = sil.run()
    energy = sil.robot.energy
    safety = diary.safety
    record = head(case) | {
        "word": sil.state_of_mission,
        "truly": outcome.reached,
        "course_mm": round(course_mm(case)),
        "t_s": round(outcome.t_s, 1),
        "goal_mm": round(outcome.goal_mm),
        "driven_mm": round(outcome.driven_mm),
        "turned_deg": round(diary.turned_deg),
        "stops": len(diary.stops),
        "looking_s": round(outcome.verifying_s, 1),
        "closest_mm": None if math.isinf(safety.closest_mm) else round(safety.closest_mm),
        "collisions": sum(not hit.struck for hit in outcome.collisions),
        "idle_s": round(energy.idle_s, 1),
        "sonar_s": round(energy.sonar_s, 1),
        "wheel_m": round(energy.wheel_m, 2),
        "accel_j": round(energy.accel_j, 1),
        **{rule.lower(): count for rule, count in safety.counts.items()},
    }
    return record, outcome, diary


def head(case: Case) -> Record:
    """Return the fields of a record that say which case it is."""
    return {
        "id": case.id,
        "policy": case.policy,
        "world": case.world,
        "seed": case.seed,
        "dead": case.dead,
        "day": case.day,
        "error": None,
    }


def work(case_id: str) -> Record:
    """Run the case of an id; never raises: a record with `error` tells what went wrong, so that the study goes on."""
    try:
        return run_case(parse_id(case_id))[0]
    except Exception as error:  # whatever a mission does, the others must run
        return failed(case_id, f"{type(error).__name__}: {error}", traceback.format_exc())


def failed(case_id: str, reason: str, details: str = "") -> Record:
    """Return the record of a case that did not run."""
    return head(parse_id(case_id)) | {"error": reason, "details": details}
