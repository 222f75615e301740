# SPDX-License-Identifier: MIT
"""One journey from its case to its record: what it took, where it stopped and looked, how near it came to walls."""

from __future__ import annotations

import math
import time
import traceback
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from hil_sim.bench.journey import Case, mission_of, parse_id
from hil_sim.bench.journey_course import length_mm
from hil_sim.bench.judge import Track, judge
from hil_sim.bench.plan import without_faults
from hil_sim.sil import Collision, Mission, Outcome, Sighting, Sil, run
from hil_sim.tables.robot import robot_table
from hil_sim.world.body import BodyModel
from hil_sim.world.model import Floats, Pose, World
from hil_sim.world.moving import MovingSolids, Walker

RECORD_FORMAT: Final = 3
"""Raised whenever a record gets another field: results of two formats do not mix."""
ARRIVED_MM: Final = 150.0
"""The robot is truly at its goal when its centre is within this of it."""
EARLY_S: Final = 330.0
"""The time in which others have measured the way that a robot makes."""
LOOKING: Final = "VERIFYING"
FREE: Final = "DRIVING"
"""Modes: of looks, and of free driving."""
MET_S: Final = 1.0
"""A person who stood, or whom a straight line from the robot's front reached, for so long, is met ahead."""
SEEN_MM: Final = 4000.0
"""Nearer than this a person ahead is seen."""
_AHEAD_DEG: Final = 50.0
"""So far off the heading the forward sonars look."""
_STANDS_MM: Final = 1.0
_PATH_MM: Final = 200.0
_RUNS_MM_S, _RESTS_MM_S = 50.0, 5.0
_TOUCH_MM: Final = robot_table().body.reach_mm + 5.0
"""No part of the body is further from its centre."""

Record = dict[str, Any]
Spot = tuple[int, int]


@dataclass
class People:
    """Where people are with each SIP: since when each of them stands, and since when the robot sees him ahead."""

    t_s: float = 0.0
    at: list[tuple[float, float]] = field(default_factory=list)
    stands_s: list[float] = field(default_factory=list)
    seen_s: list[float | None] = field(default_factory=list)
    hits: int = 0
    met: list[float] = field(default_factory=list)

    def note(self, t_s: float, robot: Pose, people: Sequence[tuple[float, float]], walls: Floats) -> None:
        """Take where people are at a moment; walls: what hides them."""
        before = self.at or list(people)
        self.stands_s = self.stands_s or [t_s] * len(people)
        self.seen_s = self.seen_s or [None] * len(people)
        for k, (was, now) in enumerate(zip(before, people, strict=True)):
            if math.dist(was, now) > _STANDS_MM:
                self.stands_s[k] = t_s
            if not is_seen(robot, now, walls):
                self.seen_s[k] = None
            elif self.seen_s[k] is None:
                self.seen_s[k] = t_s
        self.at, self.t_s = list(people), t_s

    def is_met_ahead(self, hit: Collision, heading_deg: float) -> bool:
        """Whether the robot drove on to somebody who stood before it, or whom it could see, for a second or more."""
        if not self.at:
            return False
        k = min(range(len(self.at)), key=lambda i: math.dist(self.at[i], (hit.x, hit.y)))
        since = [t for t in (self.stands_s[k], self.seen_s[k]) if t is not None]
        ahead = abs(_off_deg(Pose(hit.x, hit.y, heading_deg), self.at[k])) <= 90
        return ahead and hit.t_s - min(since) >= MET_S


def _off_deg(robot: Pose, at: tuple[float, float]) -> float:
    bearing = math.degrees(math.atan2(at[1] - robot.y_mm, at[0] - robot.x_mm))
    return (bearing - robot.heading_deg + 180) % 360 - 180


def is_seen(robot: Pose, at: tuple[float, float], walls: Floats) -> bool:
    """Whether a place is ahead of the robot, near enough, and no wall between."""
    dx, dy = at[0] - robot.x_mm, at[1] - robot.y_mm
    if math.hypot(dx, dy) > SEEN_MM or abs(_off_deg(robot, at)) > _AHEAD_DEG:
        return False
    x1, y1, x2, y2 = walls.T
    ends = [dx * (y - robot.y_mm) - dy * (x - robot.x_mm) for x, y in ((x1, y1), (x2, y2))]
    sides = [(x2 - x1) * (y - y1) - (y2 - y1) * (x - x1) for x, y in ((robot.x_mm, robot.y_mm), at)]
    return not bool(((ends[0] * ends[1] < 0) & (sides[0] * sides[1] < 0)).any())


@dataclass
class Diary:
    """What is noted with each SIP. Pass it as `trace`.

    stops: where the robot came to rest, having moved faster than 50 mm/s. looks: where it began to look. closest_mm:
    the smallest distance of the body from a wall or another solid that stands, ahead in free driving. early_mm: the
    way driven in the first 330 s.
    """

    track: Track = field(default_factory=Track)
    path: list[Spot] = field(default_factory=list)
    stops: list[Spot] = field(default_factory=list)
    looks: list[Spot] = field(default_factory=list)
    modes: dict[str, float] = field(default_factory=dict)
    people: People = field(default_factory=People)
    turned_deg: float = 0.0
    closest_mm: float | None = None
    early_mm: float = 0.0
    _mode: str = ""
    _t_s: float = 0.0
    _heading_deg: float | None = None
    _runs: bool = False
    _body: BodyModel | None = None
    _clear: tuple[float, float, float] | None = None

    def __call__(self, sil: Sil, sighting: Sighting) -> None:
        """Take a SIP."""
        self.track(sil, sighting)
        spot = (round(sil.robot.chassis.x), round(sil.robot.chassis.y))
        marks = len(self.stops), len(self.looks)
        self._note_mode(sil.mode, sighting.t_s, spot)
        if sighting.t_s <= EARLY_S:
            self.early_mm = sil.robot.chassis.travelled_mm
        self._note_turn(sil.robot.chassis.th)
        self._note_stop(abs(sil.robot.drive.v), spot)
        self._note_way(spot, (len(self.stops), len(self.looks)) != marks)
        if sil.mode == FREE and sil.robot.drive.v > _RESTS_MM_S:
            self._note_clearance(sil)
        if isinstance(sil.robot.moving, MovingSolids):
            self._note_people(sil, sil.robot.moving, sighting.t_s)

    def _note_people(self, sil: Sil, moving: MovingSolids, t_s: float) -> None:
        """Judge the contacts since the SIP before by what was there then."""
        pose = sil.robot.chassis.pose
        hits = sil.robot.hits[self.people.hits :]
        self.people.met += [
            h.t_s for h in hits if not h.struck and self.people.is_met_ahead(h, pose.heading_deg)
        ]
        self.people.hits += len(hits)
        walkers = [(a.x, a.y) for a in moving.actors if isinstance(a, Walker)]
        self.people.note(t_s, pose, walkers, sil.world.segments)

    def _note_mode(self, mode: str, t_s: float, spot: Spot) -> None:
        before = self._mode or mode
        self.modes[before] = self.modes.get(before, 0.0) + t_s - self._t_s
        if mode == LOOKING != self._mode:
            self.looks.append(spot)
        self._mode, self._t_s = mode, t_s

    def _note_way(self, spot: Spot, marked: bool) -> None:
        """Note where it is each 200 mm, and where it stops or looks: the way goes through what is marked on it."""
        if not self.path or math.dist(self.path[-1], spot) >= _PATH_MM or (marked and spot != self.path[-1]):
            self.path.append(spot)

    def _note_turn(self, heading_deg: float) -> None:
        if self._heading_deg is not None:
            self.turned_deg += abs(heading_deg - self._heading_deg)
        self._heading_deg = heading_deg

    def _note_stop(self, speed_mm_s: float, spot: Spot) -> None:
        if self._runs and speed_mm_s <= _RESTS_MM_S:
            self.stops.append(spot)
            self._runs = False
        self._runs = self._runs or speed_mm_s > _RUNS_MM_S

    def _note_clearance(self, sil: Sil) -> None:
        """Measure only where the closest so far may be undercut: no solid comes nearer than the body goes."""
        chassis = sil.robot.chassis
        if self._clear is not None and self.closest_mm is not None:
            clear, driven, turned = self._clear
            reach = math.radians(self.turned_deg - turned) * robot_table(sil.mission.robot).body.reach_mm
            if clear - (chassis.travelled_mm - driven) - reach > self.closest_mm:
                return
        if self._body is None:
            self._body = BodyModel(sil.world, None, robot_table(sil.mission.robot).body)
        clear = self._body.clearance_mm(chassis.pose)
        self._clear = clear, chassis.travelled_mm, self.turned_deg
        self.closest_mm = clear if self.closest_mm is None else min(self.closest_mm, clear)

    def fields(self) -> Record:
        """Return what goes into a record."""
        return {
            "stops": len(self.stops),
            "looks": len(self.looks),
            "turned_deg": round(self.turned_deg, 1),
            "closest_mm": None if self.closest_mm is None else round(self.closest_mm, 1),
            "early_mm": round(self.early_mm, 1),
            "modes_s": {name: round(value, 1) for name, value in sorted(self.modes.items())},
            "path": self.path,
            "stops_at": self.stops,
            "looks_at": self.looks,
        }


def run_case(case: Case) -> tuple[Record, Outcome]:
    """Run a case; return its record and, for callers that want more, all that came of it."""
    begin = time.perf_counter()
    mission = mission_of(case)
    diary = Diary()
    sil = Sil(mission, trace=diary)
    outcome = sil.run()
    people = take_people(outcome, sil.world)
    met = sum(hit.t_s in diary.people.met for hit in people)
    twin = None
    if mission.faults and any(not hit.struck for hit in outcome.collisions):
        twin = run(without_faults(mission))
        take_people(twin, sil.world)
    record = judge(outcome, diary.track, twin)
    record |= {"met_ahead": met, "walked_into": len(people) - met}
    record["looking_s"] = record.pop("verifying_s")
    record["stop_commands"] = record.pop("stops")
    record |= _arrival(sil, mission) | diary.fields()
    record["energy_j"] = round(sil.robot.energy.total_j, 1)
    record["faulty"] = list(mission.faults)
    record["limit_s"] = mission.limit_s
    return head(case) | record | {"wall_s": round(time.perf_counter() - begin, 3)}, outcome


def take_people(outcome: Outcome, world: World) -> list[Collision]:
    """Take out the collisions of a driving robot with people, who are where no wall is, and return them.

    The same mission without the fault meets people elsewhere, so chance would say which are the fault's.
    """
    people = [hit for hit in outcome.collisions if not hit.struck and _from_walls_mm(world, hit) > _TOUCH_MM]
    outcome.collisions = [hit for hit in outcome.collisions if hit not in people]
    return people


def _from_walls_mm(world: World, hit: Collision) -> float:
    """Distance of the robot's centre from what stands."""
    x1, y1, x2, y2 = world.segments.T
    dx, dy = x2 - x1, y2 - y1
    along = np.clip(((hit.x - x1) * dx + (hit.y - y1) * dy) / (dx * dx + dy * dy), 0.0, 1.0)
    return float(np.hypot(x1 + along * dx - hit.x, y1 + along * dy - hit.y).min())


def _arrival(sil: Sil, mission: Mission) -> Record:
    """How far it came, truly and by its own word."""
    begins = (sil.start.x_mm, sil.start.y_mm)
    length = length_mm(begins, mission.course)
    word = sil.state_of_mission
    chassis = sil.robot.chassis
    passed = max((event.value for event in sil.events if event.name == "WAYPOINT"), default=0)
    left = length_mm((chassis.x, chassis.y), mission.course[min(passed, len(mission.course) - 1) :])
    progress = length if word == "reached" else max(0.0, length - left)
    goal_mm = math.dist((chassis.x, chassis.y), mission.course[-1])
    return {
        "course_mm": round(length, 1),
        "progress_mm": round(progress, 1),
        "word": word,
        "truly": word == "reached" and goal_mm <= ARRIVED_MM,
        "odometry_off_mm": round(_odometry_off_mm(sil), 1),
    }


def _odometry_off_mm(sil: Sil) -> float:
    """How far the robot is from where its odometry has it."""
    chassis, start = sil.robot.chassis, sil.start
    heading = math.radians(start.heading_deg)
    x = start.x_mm + chassis.odo_x * math.cos(heading) - chassis.odo_y * math.sin(heading)
    y = start.y_mm + chassis.odo_x * math.sin(heading) + chassis.odo_y * math.cos(heading)
    return math.hypot(x - chassis.x, y - chassis.y)


def head(case: Case) -> Record:
    """Return the fields of a record that say which case it is."""
    return {
        "id": case.id,
        "driver": case.driver,
        "split": case.split,
        "row": case.row,
        "world": case.world,
        "seed": case.seed,
        "ideal": case.ideal.id,
        "error": None,
    }


def work(case_id: str) -> Record:
    """Run the case of an id; never raises: a record with `error` tells what went wrong, so that the bench goes on."""
    try:
        return run_case(parse_id(case_id))[0]
    except Exception as error:  # whatever a mission does, the others must run
        return failed(case_id, f"{type(error).__name__}: {error}", traceback.format_exc())


def failed(case_id: str, reason: str, details: str = "") -> Record:
    """Return the record of a case that did not run."""
    return head(parse_id(case_id)) | {"error": reason, "details": details}
