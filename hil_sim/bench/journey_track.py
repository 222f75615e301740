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
import numpy.typing as npt

from hil_sim.bench.journey import Case, mission_of, parse_id
from hil_sim.bench.journey_course import length_mm
from hil_sim.bench.judge import Track, judge
from hil_sim.bench.plan import without_faults
from hil_sim.core.library import mode_name
from hil_sim.robot.chassis import wrapped
from hil_sim.sil import Collision, Mission, Outcome, Sighting, Sightings, Sil, run
from hil_sim.sil.sightings import Table
from hil_sim.tables.robot import BodyShape, robot_table
from hil_sim.world.body import BodyModel, distances_mm
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
_ROUNDED_MM: Final = 2.0
"""By which the distance of two spots in whole millimetres may be more than the way between them."""
_RUNS_MM_S, _RESTS_MM_S = 50.0, 5.0
_TOUCH_MM: Final = robot_table().body.reach_mm + 5.0
"""No part of the body is further from its centre."""

Record = dict[str, Any]
Spot = tuple[int, int]
Places = npt.NDArray[np.intp]


@dataclass
class People:
    """Where people are with each SIP: since when each of them stands, and since when the robot sees him ahead."""

    t_s: float = 0.0
    at: list[tuple[float, float]] = field(default_factory=list)
    stands_s: list[float] = field(default_factory=list)
    seen_s: list[float | None] = field(default_factory=list)

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


class Company:
    """Watches the people about. Pass it as `trace` of a mission with people; met: when one was met ahead."""

    def __init__(self) -> None:
        self.met: list[float] = []
        self._people = People()
        self._hits = 0

    def __call__(self, sil: Sil, sighting: Sighting) -> None:
        """Judge the contacts since the SIP before by what was there then."""
        moving = sil.robot.moving
        assert isinstance(moving, MovingSolids)
        pose = sil.robot.chassis.pose
        hits = sil.robot.hits[self._hits :]
        self.met += [h.t_s for h in hits if not h.struck and self._people.is_met_ahead(h, pose.heading_deg)]
        self._hits += len(hits)
        walkers = [(a.x, a.y) for a in moving.actors if isinstance(a, Walker)]
        self._people.note(sighting.t_s, pose, walkers, sil.world.segments)


@dataclass(frozen=True)
class Diary:
    """What a record tells of the way.

    path: where it was each 200 mm, and where it stopped or looked. stops: where it came to rest, having moved faster
    than 50 mm/s. looks: where it began to look. closest_mm: the smallest distance of the body from a wall or another
    solid that stands, ahead in free driving. early_mm: the way driven in the first 330 s.
    """

    path: list[Spot]
    stops: list[Spot]
    looks: list[Spot]
    modes_s: dict[str, float]
    turned_deg: float
    closest_mm: float | None
    early_mm: float

    @classmethod
    def of(cls, rows: Table, world: World, body: BodyShape) -> Diary:
        """Return it of the rows of a mission (hil_sim.sil.ROW)."""
        names = np.array([mode_name(number) for number in range(int(rows["mode"].max(initial=0)) + 1)])
        mode = names[rows["mode"]]
        t_s = rows["t_ms"] / 1000
        spots = np.stack([np.rint(rows["true_x"]), np.rint(rows["true_y"])], axis=-1).astype(int)
        stops, looks = _stops(abs(rows["v"])), _begins(mode == LOOKING)
        turned = np.cumsum(abs(np.diff(rows["th"], prepend=rows["th"][:1])))
        free = np.flatnonzero((mode == FREE) & (rows["v"] > _RESTS_MM_S))
        before = rows["mode"][np.arange(-1, len(rows) - 1).clip(0)]
        spent_s = np.bincount(before, np.diff(t_s, prepend=0.0))
        way = rows["travelled_mm"]
        return cls(
            [_spot(spots[k]) for k in _path(spots, way, np.union1d(stops, looks))],
            [_spot(spots[k]) for k in stops],
            [_spot(spots[k]) for k in looks],
            {str(names[k]): float(spent_s[k]) for k in set(before.tolist())},
            float(turned[-1]) if len(turned) else 0.0,
            _closest_mm(rows[free], way[free] + np.radians(turned[free]) * body.reach_mm, world, body),
            float(way[t_s <= EARLY_S][-1:].sum()),
        )

    def fields(self) -> Record:
        """Return what goes into a record."""
        return {
            "stops": len(self.stops),
            "looks": len(self.looks),
            "turned_deg": round(self.turned_deg, 1),
            "closest_mm": None if self.closest_mm is None else round(self.closest_mm, 1),
            "early_mm": round(self.early_mm, 1),
            "modes_s": {name: round(value, 1) for name, value in sorted(self.modes_s.items())},
            "path": self.path,
            "stops_at": self.stops,
            "looks_at": self.looks,
        }


def _spot(place: Places) -> Spot:
    x, y = place.tolist()
    return x, y


def _begins(holds: npt.NDArray[np.bool_]) -> Places:
    """Where something begins to hold."""
    return np.flatnonzero(holds & ~np.concatenate([[False], holds[:-1]]))


def _stops(speed_mm_s: Floats) -> Places:
    """Where the robot came to rest, having moved."""
    marks = np.flatnonzero((speed_mm_s > _RUNS_MM_S) | (speed_mm_s <= _RESTS_MM_S))
    return marks[_begins(speed_mm_s[marks] <= _RESTS_MM_S)][
        int(len(marks) > 0 and speed_mm_s[marks[0]] <= _RESTS_MM_S) :
    ]


def _path(spots: Places, way_mm: Floats, marked: Places) -> list[int]:
    """Where the path is noted: as far as it goes on, nothing is nearer to the last spot than the way driven."""
    path = [0] if len(spots) else []
    marks = [int(k) for k in marked if k > 0] + [len(spots)]
    k = 0
    while path:
        k = max(k + 1, int(np.searchsorted(way_mm, way_mm[path[-1]] + _PATH_MM - _ROUNDED_MM)))
        if k >= marks[0]:
            k = marks.pop(0)
            if k == len(spots):
                break
            if _spot(spots[k]) != _spot(spots[path[-1]]):
                path.append(k)
        elif math.dist(spots[k], spots[path[-1]]) >= _PATH_MM:
            path.append(k)
    return path


def _closest_mm(rows: Table, moved_mm: Floats, world: World, shape: BodyShape) -> float | None:
    """The smallest clearance. moved_mm: no point of the body has moved further by then, so that it is measured only
    where the smallest so far may be undercut."""
    body = BodyModel(world, None, shape)
    closest = math.inf
    k = 0
    while k < len(rows):
        clear = body.clearance_mm(Pose(rows["true_x"][k], rows["true_y"][k], wrapped(rows["th"][k])))
        closest = min(closest, clear)
        k = max(k + 1, int(np.searchsorted(moved_mm, moved_mm[k] + clear - closest)))
    return closest if len(rows) else None


def run_case(case: Case) -> tuple[Record, Outcome]:
    """Run a case; return its record and, for callers that want more, all that came of it."""
    begin = time.perf_counter()
    mission = mission_of(case)
    sightings, company = Sightings(), Company()
    sil = Sil(mission, trace=company if mission.movers else None, sightings=sightings)
    outcome = sil.run()
    seen = sightings.seen
    people = take_people(outcome, sil.world)
    met = sum(hit.t_s in company.met for hit in people)
    twin = None
    if mission.faults and any(not hit.struck for hit in outcome.collisions):
        twin = run(without_faults(mission))
        take_people(twin, sil.world)
    record = judge(outcome, Track.of(seen), twin)
    record |= {"met_ahead": met, "walked_into": len(people) - met}
    record["looking_s"] = record.pop("verifying_s")
    record["stop_commands"] = record.pop("stops")
    record |= _arrival(sil, mission)
    record |= Diary.of(seen.rows, sil.world, robot_table(mission.robot).body).fields()
    record["energy_j"] = round(sil.robot.energy.total_j, 1)
    record["faulty"] = list(mission.faults)
    record["limit_s"] = mission.limit_s
    return head(case) | record | {"wall_s": round(time.perf_counter() - begin, 3)}, outcome


def take_people(outcome: Outcome, world: World) -> list[Collision]:
    """Take out the collisions of a driving robot with people, who are where no wall is, and return them.

    The same mission without the fault meets people elsewhere, so chance would say which are the fault's.
    """
    people = [
        hit
        for hit in outcome.collisions
        if not hit.struck and distances_mm(world.segments, hit.x, hit.y).min() > _TOUCH_MM
    ]
    outcome.collisions = [hit for hit in outcome.collisions if hit not in people]
    return people


def _is_off_walls(world: World, hit: Collision) -> bool:
    return bool(distances_mm(world.segments, hit.x, hit.y).min() > _TOUCH_MM)


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
