# SPDX-License-Identifier: MIT
"""What `bench journey` runs: rows of missions by their conditions, and from a case, by its seed alone, a mission."""

from __future__ import annotations

import re
import zlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np

from hil_sim.bench import plan
from hil_sim.bench.journey_course import DRIFT_DEG_M, ROUGH_DRIFT_DEG_M, drift_course, length_mm
from hil_sim.bench.journey_worlds import LIMIT_S, SETS, Place, place_of
from hil_sim.bench.worlds import GENERATED
from hil_sim.errors import SimError
from hil_sim.sil import Mission
from hil_sim.world.files import world_names

Rng = np.random.Generator

IDEAL: Final = "ideal"
"""The driver of the ideal time: no diagnosis, a robot without faults, everything else the same."""
IDEAL_CONFIG: Final[Mapping[str, int | str]] = {"profile": "argus", "diagnosis": "off"}
MIDWAY: Final = (0.3, 0.6)
"""A fault midway begins after such a part of the course."""
ROOMS: Final = ("office", "lab", "corridor", "gen-room", "gen-corridor", "gen-hall")
GROUND: Final[Mapping[str, tuple[str, ...]]] = {
    "rooms": ROOMS,
    "office": ("office",),
    "maps": ("map-office", "map-floor"),
    **{name: tuple(f"{name}-{k}" for k in range(1, 9)) for name in SETS},
}
"""Where a row drives: the worlds of each name. An obstacle set has eight for each seed."""


@dataclass(frozen=True)
class Condition:
    """What is unlike a healthy robot in the plain model with nobody about."""

    says: str
    people: bool = False
    physics: str = ""
    quirks: str = "robot"
    faults: Callable[[Rng, int], list[str]] | None = None


def _single(rng: Rng, turn: int, count: int) -> list[str]:
    """Faults of so many different sonars, mostly forward ones; the kind is the next one with each turn."""
    kinds = list(plan.FAULTS)
    texts, hit = [], set[int]()
    for k in range(count):
        kind = kinds[(turn + 3 * k) % len(kinds)]
        rows = plan.FAULTS[kind]
        _, parameter = rows[(turn // len(kinds)) % len(rows)]
        sonar = _other(rng, hit)
        hit.add(sonar)
        if parameter == "value":
            parameter = f"value={int(rng.integers(300, 4000))}"
        texts.append(f"{kind}:{sonar}" + (f":{parameter}" if parameter else ""))
    return texts


def _other(rng: Rng, hit: set[int]) -> int:
    while (sonar := plan.target(rng)) in hit:
        pass
    return sonar


def _most(rng: Rng, _turn: int) -> list[str]:
    forward = rng.choice(plan.FORWARD, len(plan.FORWARD) - 1, replace=False)
    return [f"off:{'+'.join(str(n) for n in sorted(int(n) for n in forward))}"]


def _neighbours(rng: Rng, turn: int) -> list[str]:
    first = int(rng.integers(1, 6))
    kind = ("off", "slow", "wrong")[turn % 3]
    parameter = {"off": "", "slow": ":n=5", "wrong": ":scale=0.8"}[kind]
    return [f"{kind}:{first}+{first + 1}{parameter}"]


CONDITIONS: Final[Mapping[str, Condition]] = {
    "people": Condition("one to three people walk about", people=True),
    "rough": Condition("on a rough day", physics="rough-day"),
    "recorded": Condition("sonars as recorded", physics="recorded"),
    "steps": Condition("sonars as recorded, in coarse steps", physics="coarse-steps"),
    "mobilesim": Condition("on the vendor's emulator", quirks="mobilesim"),
    "one": Condition("one fault", faults=lambda rng, turn: _single(rng, turn, 1)),
    "two": Condition("two faults", faults=lambda rng, turn: _single(rng, turn, 2)),
    "neighbours": Condition("two neighbours fail at once", faults=_neighbours),
    "most": Condition("five of the six ahead are off", faults=_most),
    "front": Condition("the front array is lost", faults=lambda _rng, _turn: ["off:front"]),
    "front-slow": Condition("the front array is late", faults=lambda _rng, _turn: ["slow:front:n=5"]),
    "front-scaled": Condition(
        "the front array is off by a fifth", faults=lambda _r, _t: ["wrong:front:scale=0.8"]
    ),
}
START: Final = "start"
"""Says of faults that they are there from the beginning; without it they come midway."""
DEFAULT_ROWS: Final = (
    "rooms", "rooms+rough", "rooms+people", "rooms+one", "rooms+one+start", "rooms+one+rough", "rooms+one+people",
    "rooms+two", "rooms+neighbours", "rooms+front", "rooms+most", "maps", "maps+one", "maps+mobilesim", *SETS,
)  # fmt: skip


@dataclass(frozen=True)
class Row:
    """One row of the table: where it drives, and under which conditions."""

    name: str
    ground: str
    conditions: tuple[str, ...]
    from_start: bool

    @property
    def physics(self) -> str:
        """As for argus-sim."""
        return next((CONDITIONS[name].physics for name in self.conditions if CONDITIONS[name].physics), "")

    @property
    def drift_deg_m(self) -> float:
        """What its courses are made for: a rough day has courses of its own."""
        return ROUGH_DRIFT_DEG_M if self.physics == "rough-day" else DRIFT_DEG_M

    @property
    def quirks(self) -> str:
        """As for argus-sim."""
        return "mobilesim" if "mobilesim" in self.conditions else "robot"

    @property
    def people(self) -> bool:
        """Whether people walk about."""
        return any(CONDITIONS[name].people for name in self.conditions)

    @property
    def has_faults(self) -> bool:
        """Whether sonars fail."""
        return any(CONDITIONS[name].faults for name in self.conditions)

    @property
    def healthy(self) -> str:
        """Name of the row that is the same without faults: the ideal is of that."""
        kept = [name for name in self.conditions if CONDITIONS[name].faults is None]
        return "+".join([self.ground, *kept])

    @property
    def says(self) -> str:
        """The row in words."""
        words = [CONDITIONS[name].says for name in self.conditions]
        when = ["from the start" if self.from_start else "midway"] if self.has_faults else []
        return ", ".join([self.ground, *(words or ["healthy, nobody about"]), *when])


def parse_row(text: str) -> Row:
    """Return the row of GROUND[+CONDITION...]; SimError when there is none.

    >>> parse_row("rooms+one+rough").healthy
    'rooms+rough'
    """
    ground, *words = text.split("+")
    conditions = (
        tuple(sorted({word for word in words if word != START}, key=list(CONDITIONS).index))
        if all(word == START or word in CONDITIONS for word in words)
        else None
    )
    if ground not in GROUND or conditions is None:
        raise SimError(
            f"row '{text}': write one of {', '.join(GROUND)}, then +{', +'.join(CONDITIONS)} or +{START} as wanted"
        )
    from_start = START in words
    row = Row("+".join([ground, *conditions, *[START] * from_start]), ground, conditions, from_start)
    if row.from_start and not row.has_faults:
        raise SimError(f"row '{text}': nothing fails in it; leave +{START} out")
    return row


@dataclass(frozen=True)
class Case:
    """One mission. `driver`: IDEAL, or a profile with settings if wanted."""

    driver: str
    split: str
    row: str
    world: str
    seed: int

    @property
    def id(self) -> str:
        """Name that `--one` takes."""
        return f"{self.driver}/{self.split}/{self.row}/{self.world}/{self.seed}"

    @property
    def ideal(self) -> Case:
        """The case whose time is the ideal of this one."""
        return Case(IDEAL, self.split, parse_row(self.row).healthy, self.world, self.seed)


_ID: Final = re.compile(r"(?P<driver>[^/]+)/(?P<split>\w+)/(?P<row>[^/]+)/(?P<world>.+)/(?P<seed>\d{1,15})")


def parse_id(text: str) -> Case:
    """Return the case of an id; SimError when it is none.

    >>> parse_id("argus/tune/rooms+rough/office/7").ideal.id
    'ideal/tune/rooms+rough/office/7'
    """
    match = _ID.fullmatch(text.strip())
    if match is None or match["split"] not in plan.SPLITS:
        raise SimError(
            f"'{text}' is no id of a journey; take one from results.jsonl, for example argus/tune/rooms/office/7"
        )
    _config(match["driver"])
    row = parse_row(match["row"]).name
    return Case(match["driver"], match["split"], row, match["world"], int(match["seed"]))


def make_cases(
    profiles: Sequence[str],
    split: str,
    rows: Iterable[str],
    seeds: Iterable[int],
    worlds: Sequence[str] = (),
) -> list[Case]:
    """Return the cases: in each world of each row, for each seed, the ideal and each profile.

    worlds: instead of those of the rows that drive through rooms and maps.
    """
    found: dict[Case, None] = {}
    for row in map(parse_row, rows):
        own = worlds if worlds and row.ground not in SETS else GROUND[row.ground]
        for seed in seeds:
            for world in own:
                cases = [Case(profile, split, row.name, world, seed) for profile in profiles]
                found |= dict.fromkeys([cases[0].ideal, *cases])
    return list(found)


def _config(driver: str) -> Mapping[str, int | str]:
    return IDEAL_CONFIG if driver == IDEAL else plan.check_profile(driver)


def _rng(case: Case, purpose: str) -> Rng:
    """A stream of its own for each purpose; driver and conditions change none, so all meet the same."""
    words = ("journey", case.world.rsplit("/", 1)[-1], purpose)
    return np.random.default_rng(
        [plan.SPLITS[case.split], case.seed, *(zlib.crc32(w.encode()) for w in words)]
    )


@lru_cache(maxsize=16)
def _place(world: str, split: str, seed: int, drift_deg_m: float) -> Place:
    if world in GENERATED or world in world_names() or world.endswith((".map", ".yaml", ".yml")):
        made, field, path = plan.world_of(world, split, seed)
        rng = _rng(Case("", split, "", world, seed), "course")
        return Place(made, field, path, drift_course(made, field, rng, drift_deg_m), LIMIT_S)
    return place_of(world, (plan.SPLITS[split], seed), drift_deg_m)


def faults_of(case: Case) -> tuple[str, ...]:
    """Return the faults of a case, in the grammar of docs/scenarios.md."""
    row = parse_row(case.row)
    if case.driver == IDEAL or not row.has_faults:
        return ()
    place = _place(case.world, case.split, case.seed, row.drift_deg_m)
    rng = _rng(case, "fault")
    onset = rng.uniform(*MIDWAY) * length_mm(place.begins[:2], place.course)
    turn = case.seed + zlib.crc32(case.world.encode())
    texts = []
    for name in row.conditions:
        make = CONDITIONS[name].faults
        texts += make(rng, turn) if make is not None else []
    if row.from_start:
        return tuple(texts)
    return tuple(_begins(text, onset) for text in texts)


def _begins(text: str, onset_mm: float) -> str:
    kind, sonars, *parameters = text.split(":")
    return ":".join([kind, f"{sonars}@travelled>{onset_mm:.0f}", *parameters])


def mission_of(case: Case) -> Mission:
    """Return the mission of a case."""
    row = parse_row(case.row)
    place = _place(case.world, case.split, case.seed, row.drift_deg_m)
    return Mission(
        place.path,
        place.course,
        start=place.start,
        faults=faults_of(case),
        seed=int(_rng(case, "noise").integers(2**62)),
        config=_config(case.driver),
        movers=plan.people(place.field, place.begins[:2], _rng(case, "people")) if row.people else (),
        limit_s=place.limit_s,
        physics=row.physics,
        quirks=row.quirks,
    )
