# SPDX-License-Identifier: MIT
"""What the study of journeys runs: cases by their id, and from a case, by its seed alone, a mission."""

from __future__ import annotations

import math
import re
import zlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations, product
from typing import Final

import numpy as np

from hil_sim.bench import plan
from hil_sim.bench.course import Point, make_course
from hil_sim.bench.journey_course import ROUGH_DRIFT_DEG_M, SCALE, drift_at_goal_mm, length_mm
from hil_sim.bench.journey_worlds import FLOORS, place_of
from hil_sim.bench.plan import SPLITS
from hil_sim.errors import SimError
from hil_sim.sil import Mission
from hil_sim.world.model import Pose
from hil_sim.world.physics import SETS

FORWARD: Final = plan.FORWARD
POLICIES: Final[Mapping[str, Mapping[str, str]]] = {
    "paper": {"profile": "paper", "policy": "paper"},
    "fewest": {"profile": "paper", "policy": "fewest"},
    "least-turn": {"profile": "paper", "policy": "least-turn"},
    "ring": {"profile": "paper", "policy": "ring"},
    "adaptive": {"profile": "argus", "policy": "adaptive"},
}
"""The first four differ in their planner alone; the last one is what argusd does by default."""
WORLDS: Final = ("office", "lab", "corridor", "map-office", "map-floor", "demo")
"""The last two are drawn from the seed, written and read as ARIA maps."""
HEALTHY: Final = "none"
ARRAYS: Final = ("front", "rear")
SPLIT: Final = "judge"
"""Of the seeds: nothing was tuned on these."""
LIMIT_S: Final = 900.0
COURSE_MM: Final = (5000.0, 10_000.0)
_TRIES: Final = 60
_DRIFT_OFF_MM: Final = 80.0
"""A rough day's courses are those at whose goal odometry has the robot no farther off: else none is truly reached."""
_BACK_MM: Final = 2550.0
"""... or, where no other is found, there and back, so far each way."""

Rng = np.random.Generator


def dead_sets() -> list[str]:
    """Return the 63 sets of dead front sonars, smallest first, as they are written: 1, 1+2, 1+2+3+4+5+6."""
    sizes = range(1, len(FORWARD) + 1)
    return ["+".join(map(str, chosen)) for size in sizes for chosen in combinations(FORWARD, size)]


def count_dead(dead: str) -> int | None:
    """Return how many of the six are dead; None for a whole array."""
    return None if dead in ARRAYS else 0 if dead == HEALTHY else len(dead.split("+"))


@dataclass(frozen=True)
class Case:
    """One mission: who drives (a policy), where, and which sonars are dead from the beginning."""

    policy: str
    split: str
    world: str
    seed: int
    dead: str
    day: str

    @property
    def id(self) -> str:
        """Name that `--one` takes."""
        return f"{self.policy}/{self.split}/{self.world}/{self.seed}/{self.dead}/{self.day}"

    @property
    def run(self) -> tuple[str, str, int, str, str]:
        """What two policies have in common that drive the same run."""
        return self.split, self.world, self.seed, self.dead, self.day


_ID: Final = re.compile(r"([^/]+)/(\w+)/([^/]+)/(\d{1,15})/([^/]+)/([^/]+)")


def parse_id(text: str) -> Case:
    """Return the case of an id; SimError when it is none.

    >>> parse_id("adaptive/judge/office/3/1+2/plain").dead
    '1+2'
    """
    match = _ID.fullmatch(text.strip())
    if match is not None:
        policy, split, world, seed, dead, day = match.groups()
        known = policy in POLICIES and split in SPLITS and world in WORLDS and day in SETS
        if known and dead in (HEALTHY, *ARRAYS, *dead_sets()):
            return Case(policy, split, world, int(seed), dead, day)
    raise SimError(
        f"'{text}' is no id of a journey; take one of results.jsonl, for example adaptive/judge/office/3/1+2/plain"
    )


def make_cases(
    policies: Iterable[str],
    worlds: Iterable[str],
    seeds: Iterable[int],
    dead: Sequence[str],
    *,
    split: str = SPLIT,
    day: str = "plain",
) -> list[Case]:
    """Return the cases, seed by seed, so that what is interrupted has covered everything equally."""
    rows = product(seeds, dead, worlds, policies)
    return [Case(policy, split, world, seed, which, day) for seed, which, world, policy in rows]


def parse_dead(text: str) -> list[str]:
    """Return the sets of dead sonars of a list with commas; `all`, `one`, `two` ... `six` stand for many of them.

    >>> parse_dead("none,six,front")
    ['none', '1+2+3+4+5+6', 'front']
    """
    sizes = dict(zip(("one", "two", "three", "four", "five", "six"), range(1, 7), strict=True))
    found: dict[str, None] = {}
    for part in (word for word in text.split(",") if word):
        if part == "all":
            found |= dict.fromkeys([HEALTHY, *dead_sets(), *ARRAYS])
        elif part in sizes:
            found |= dict.fromkeys(name for name in dead_sets() if count_dead(name) == sizes[part])
        elif part in (HEALTHY, *ARRAYS, *dead_sets()):
            found[part] = None
        else:
            raise SimError(
                f"'{part}' is no set of dead sonars; write all, {', '.join(sizes)}, {HEALTHY}, "
                f"{', '.join(ARRAYS)}, or sonars of 1 to 6 in order: 1+2"
            )
    return list(found)


def _rng(case: Case, purpose: str) -> Rng:
    """A stream of its own for each purpose; policy and faults change none, so all drive the same course."""
    words = ("experiment", case.world, purpose)
    return np.random.default_rng([SPLITS[case.split], case.seed, *(zlib.crc32(w.encode()) for w in words)])


@lru_cache(maxsize=16)
def _course(world: str, split: str, seed: int, day: str) -> tuple[str, Pose, tuple[Point, ...]]:
    """World, start and way of 5 to 10 m."""
    if world in FLOORS:
        place = place_of(world, (SPLITS[split], seed))
        made, field, path = place.world, place.field, place.path
    else:
        made, field, path = plan.world_of(world, split, seed)
    rng = _rng(Case("", split, world, seed, "", ""), "course")
    begins = (made.start.x_mm, made.start.y_mm)
    fallback: tuple[Point, ...] = ()
    for _ in range(_TRIES):
        course = make_course(made, field, float(rng.uniform(COURSE_MM[0], COURSE_MM[1] - 2000)), rng)
        if COURSE_MM[0] <= length_mm(begins, course) <= COURSE_MM[1]:
            if day == "plain" or _off_mm(begins, course) <= _DRIFT_OFF_MM:
                return path, made.start, course
            fallback = fallback or there_and_back(begins, course, _BACK_MM)
    if fallback:
        return path, made.start, fallback
    raise SimError(f"world {world}, seed {seed}: no course of 5 to 10 m; choose another seed")


def _off_mm(begins: Point, course: tuple[Point, ...]) -> float:
    """How far drift, either way, and scale of a rough day have the robot from its goal."""
    drift = max(drift_at_goal_mm(begins, course, by) for by in (-ROUGH_DRIFT_DEG_M, ROUGH_DRIFT_DEG_M))
    return drift + SCALE * math.dist(begins, course[-1])


def there_and_back(begins: Point, course: Sequence[Point], way_mm: float) -> tuple[Point, ...]:
    """Return the first part of a course, so far, and the way back.

    >>> there_and_back((0.0, 0.0), ((1000.0, 0.0), (1000.0, 5000.0)), 3000.0)
    ((1000.0, 0.0), (1000.0, 2000.0), (1000.0, 0.0), (0.0, 0.0))
    """
    out, left = [begins], way_mm
    for end in course:
        leg = math.dist(out[-1], end)
        part = min(1.0, left / leg)
        out.append((out[-1][0] + (end[0] - out[-1][0]) * part, out[-1][1] + (end[1] - out[-1][1]) * part))
        left -= leg
        if left <= 0:
            break
    return (*out[1:], *reversed(out[:-1]))


def mission_of(case: Case) -> Mission:
    """Return the mission of a case."""
    path, _, course = _course(case.world, case.split, case.seed, case.day)
    return Mission(
        path,
        course,
        faults=() if case.dead == HEALTHY else (f"off:{case.dead}",),
        seed=int(_rng(case, "noise").integers(2**62)),
        config=POLICIES[case.policy],
        limit_s=LIMIT_S,
        physics="" if case.day == "plain" else case.day,
    )


def course_mm(case: Case) -> float:
    """Return the length of the way of a case."""
    _, start, course = _course(case.world, case.split, case.seed, case.day)
    return length_mm((start.x_mm, start.y_mm), course)
