# SPDX-License-Identifier: MIT
"""What a bench runs: cases by their id, and from a case, by its seed alone, a mission."""

from __future__ import annotations

import dataclasses
import fnmatch
import re
import tempfile
import zlib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from pathlib import Path
from typing import Any, Final

import numpy as np

from hil_sim.bench.course import LEG_MM, ROOM_MM, Field, Floats, Point, make_course, make_field
from hil_sim.bench.worlds import GENERATED, OPEN, make_world
from hil_sim.core.library import setting_value
from hil_sim.errors import InputError, SimError
from hil_sim.sil import Mission
from hil_sim.sonar.params import SonarParams
from hil_sim.tables.robot import robot_table
from hil_sim.world.files import load_world, world_names
from hil_sim.world.model import World
from hil_sim.world.movers import Person

Rng = np.random.Generator

SPLITS: Final = {"tune": 0x7A3D, "judge": 0x1E55}
"""Salt of everything random: no course, fault, noise or generated world of one split occurs in the other."""
ROBOT: Final = robot_table()
FORWARD: Final = ROBOT.forward
SONARS: Final = ROBOT.sonars
FORWARD_SHARE: Final = 0.75
"""Share of the faults that hit one of the forward six; the others hit one of the other ten."""
REPAIR_SHARE: Final = 1 / 3
"""Share of the single faults that are repaired before the mission ends."""
FAULT_COURSE_MM: Final = 45_000.0
FAULT_LIMIT_S: Final = 420.0
FREE_COURSE_MM: Final = 90_000.0
FREE_LIMIT_S: Final = 600.0
ONSET_MM: Final = (1000.0, 9000.0)
"""A fault begins when so much of the way is driven, so always in motion."""
PEOPLE_AWAY_MM: Final = 1800.0
PEOPLE_LEG_MM: Final = 1500.0
REPAIR_S: Final = (120.0, 160.0)
"""When a repaired fault ends, robot time: 30 s after most onsets have had their time to be found."""

FAULTS: Final[Mapping[str, tuple[tuple[str, str], ...]]] = {
    "off": (("off", ""),),
    "silent": (("silent", ""),),
    "stuck": (("stuck", ""), ("stuck-value", "value")),
    "wrong": tuple(
        (f"wrong-{name}{value:+g}" if name != "scale" else f"wrong-scale{value:g}", f"{name}={value:g}")
        for name, values in (
            ("scale", (0.5, 0.8, 1.2, 1.5)),
            ("offset", (-600.0, -300.0, 300.0, 600.0)),
            ("angle", (-25.0, -15.0, 15.0, 25.0)),
        )
        for value in values
    ),
    "garbage": (("garbage", ""),),
    "slow": tuple((f"slow-{n}", f"n={n}") for n in (3, 5, 8)),
    "intermittent": tuple((f"intermittent-{p:g}", f"p={p:g}") for p in (0.2, 0.5, 0.8)),
}
"""Severities of each kind: name of the variant, parameter of the fault; `value` is drawn."""
SINGLE: Final = {name: (kind, text) for kind, rows in FAULTS.items() for name, text in rows}
KINDS: Final = (*FAULTS, "pair", "free")
VARIANTS: Final[Mapping[str, tuple[str, ...]]] = {
    **{kind: tuple(name for name, _ in rows) for kind, rows in FAULTS.items()},
    "pair": ("pair",),
    "free": ("free", "free-people"),
}
SWEEPS: Final[Mapping[str, tuple[float, ...]]] = {
    "noise_mm": (2.0, 10.0, 20.0, 40.0),
    "crosstalk": (0.0, 0.02, 0.05, 0.1),
}
"""Values of the sonar model that --sensitivity tries beside its defaults, one at a time."""


@dataclass(frozen=True)
class Case:
    """One mission of the bench. `profile` may carry settings: `argus:suspect_readings=5`."""

    profile: str
    split: str
    world: str
    seed: int
    variant: str
    sonar: tuple[tuple[str, float], ...] = ()

    @property
    def id(self) -> str:
        """Name that `--one` takes."""
        swept = "".join(f"~{name}={value:g}" for name, value in self.sonar)
        return f"{self.profile}/{self.split}/{self.world}/{self.seed}/{self.variant}{swept}"

    @property
    def kind(self) -> str:
        """Kind of what is injected: a fault kind, `pair` or `free`."""
        return self.variant.split("-")[0]

    @property
    def place(self) -> str:
        """`open` for halls, `room` for everything else."""
        return "open" if Path(self.world).stem in OPEN else "room"


_VARIANTS: Final = tuple(name for names in VARIANTS.values() for name in names)
_ID: Final = re.compile(r"(?P<profile>[^/]+)/(?P<split>\w+)/(?P<world>.+)/(?P<seed>\d+)/(?P<rest>[^/]+)")


def parse_id(text: str) -> Case:
    """Return the case of an id; SimError when it is none.

    >>> parse_id("argus/tune/office/7/wrong-scale0.5~noise_mm=20").id
    'argus/tune/office/7/wrong-scale0.5~noise_mm=20'
    """
    match = _ID.fullmatch(text.strip())
    if match is not None and match["split"] in SPLITS:
        variant, *swept = match["rest"].split("~")
        sonar = _swept(swept)
        if variant in _VARIANTS and sonar is not None:
            check_profile(match["profile"])
            return Case(match["profile"], match["split"], match["world"], int(match["seed"]), variant, sonar)
    raise SimError(
        f"'{text}' is no id of a mission; take one from results.jsonl, for example argus/tune/office/7/off"
    )


def _swept(parts: Sequence[str]) -> tuple[tuple[str, float], ...] | None:
    """The parameters of the sonar model that an id names; None when one is none."""
    pairs = [part.partition("=") for part in parts]
    try:
        sonar = tuple((name, float(value)) for name, _, value in pairs)
    except ValueError:
        return None
    return sonar if all(name in SWEEPS for name, _ in sonar) else None


def check_profile(text: str) -> dict[str, int | str]:
    """Return the settings of NAME[:KEY=VALUE...]; SimError when one is unknown."""
    name, *pairs = text.split(":")
    config: dict[str, int | str] = {}
    for pair in (f"profile={name}", *pairs):
        key, equals, value = pair.partition("=")
        try:
            if not equals:
                raise InputError(
                    f"'{pair}' is no setting; write NAME:KEY=VALUE, for example argus:step_mm=100"
                )
            setting_value(key, value)
        except InputError as error:
            raise SimError(f"profile '{text}': {error}") from None
        config[key] = value
    return config


def find_worlds(globs: Sequence[str]) -> list[str]:
    """Return the worlds that patterns match: names of ours, generated ones, or files. SimError for a miss."""
    found: dict[str, None] = {}
    for pattern in (part for glob in globs for part in glob.split(",") if part):
        names = fnmatch.filter([*world_names(), *GENERATED], pattern)
        if not names and pattern.endswith((".map", ".yaml", ".yml")):
            whole = Path(pattern)
            anchor = Path(whole.anchor) if whole.is_absolute() else Path()
            names = sorted(map(str, anchor.glob(str(whole.relative_to(anchor) if whole.anchor else whole))))
        if not names:
            have = ", ".join([*world_names(), *GENERATED])
            raise SimError(
                f"--worlds {pattern}: matches nothing; there are {have}, or give .yaml or .map files"
            )
        found |= dict.fromkeys(names)
    return list(found)


def make_cases(
    profiles: Iterable[str],
    split: str,
    worlds: Iterable[str],
    seeds: Iterable[int],
    kinds: Sequence[str],
    *,
    every: bool = False,
    sensitivity: bool = False,
) -> list[Case]:
    """Return the cases of a bench: one of each kind for a world and a seed, or with `every` each severity.

    The severity of a kind is the next one with each seed. Profiles meet the same missions.
    """
    sweeps: list[tuple[tuple[str, float], ...]] = [()]
    if sensitivity:
        sweeps += [((name, value),) for name, values in SWEEPS.items() for value in values]
    profiles = list(profiles)
    return [
        Case(profile, split, world, seed, variant, sonar)
        for seed, world, kind in product(seeds, worlds, kinds)
        for variant in _variants(kind, seed, world, every)
        for sonar, profile in product(sweeps, profiles)
    ]


def _variants(kind: str, seed: int, world: str, every: bool) -> tuple[str, ...]:
    """The severities of a kind that come up for a seed in a world."""
    names = VARIANTS[kind]
    return names if every else (names[(seed + zlib.crc32(_stem(world).encode())) % len(names)],)


# ---- from a case to a mission ------------------------------------------------------------------------------------


def _stem(world: str) -> str:
    return Path(world).stem


@lru_cache(maxsize=1)
def _folder() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory(prefix="argus-bench-")


@lru_cache(maxsize=32)
def world_of(name: str, split: str, seed: int) -> tuple[World, Field, str]:
    """Return a world, what is known of its room, and what `Mission.world` calls it."""
    if name in GENERATED:
        world, field, path = make_world(name, (SPLITS[split], seed), Path(_folder().name))
        return world, field, str(path)
    world, field = _fixed_world(name)
    return world, field, name


@lru_cache(maxsize=32)
def _fixed_world(name: str) -> tuple[World, Field]:
    world = load_world(name)
    return world, make_field(world)


def _rng(case: Case, purpose: str) -> Rng:
    """A stream of its own for each purpose; the profile and the swept parameters change none."""
    words = (_stem(case.world), case.variant, purpose)
    return np.random.default_rng([SPLITS[case.split], case.seed, *(zlib.crc32(w.encode()) for w in words)])


def target(rng: Rng, besides: int | None = None) -> int:
    """Draw the sonar that fails: three times of four one that faces forward."""
    others = [n for n in range(SONARS) if n not in FORWARD]
    while True:
        pool = list(FORWARD) if rng.random() < FORWARD_SHARE else others
        sonar = int(rng.choice(pool))
        if sonar != besides:
            return sonar


def _fault(rng: Rng, variant: str, sonar: int, repaired: bool) -> str:
    kind, parameter = SINGLE[variant]
    onset, end = rng.uniform(*ONSET_MM), rng.uniform(*REPAIR_S)
    if parameter == "value":
        parameter = f"value={int(rng.integers(300, 4000))}"
    when = f"travelled>{onset:.0f}" + (f"-{end:.1f}s" if repaired else "")
    return f"{kind}:{sonar}@{when}" + (f":{parameter}" if parameter else "")


def faults_of(case: Case) -> tuple[str, ...]:
    """Return the faults of a case, in the grammar of docs/scenarios.md."""
    rng = _rng(case, "fault")
    if case.kind == "free":
        return ()
    if case.kind == "pair":
        first, second = rng.choice(sorted(SINGLE), 2)
        one = target(rng)
        other = target(rng, besides=one)
        return _fault(rng, str(first), one, False), _fault(rng, str(second), other, False)
    return (_fault(rng, case.variant, target(rng), bool(rng.random() < REPAIR_SHARE)),)


def mission_of(case: Case) -> Mission:
    """Return the mission of a case."""
    world, field, name = world_of(case.world, case.split, case.seed)
    free = case.kind == "free"
    course = make_course(world, field, FREE_COURSE_MM if free else FAULT_COURSE_MM, _rng(case, "course"))
    more: dict[str, Any] = {}
    if case.variant == "free-people":
        more["movers"] = people(field, (world.start.x_mm, world.start.y_mm), _rng(case, "people"))
    return Mission(
        name,
        course,
        faults=faults_of(case),
        seed=int(_rng(case, "noise").integers(2**62)),
        config=check_profile(case.profile),
        sonar=dict(case.sonar),
        limit_s=FREE_LIMIT_S if free else FAULT_LIMIT_S,
        **more,
    )


def with_people(case: Case) -> Mission:
    """Return the mission of a case with people about, also where the case has none."""
    mission = mission_of(case)
    if mission.movers:
        return mission
    world, field, _ = world_of(case.world, case.split, case.seed)
    movers = people(field, (world.start.x_mm, world.start.y_mm), _rng(case, "people"))
    return dataclasses.replace(mission, movers=movers)


def people(field: Field, start: Point, rng: Rng) -> tuple[Person, ...]:
    """Return one to three people who walk back and forth where the robot drives, none of them near its start."""
    places = field.places(ROOM_MM)
    walkers = []
    for _ in range(int(rng.integers(1, 4))):
        far = places[np.hypot(places[:, 0] - start[0], places[:, 1] - start[1]) > PEOPLE_AWAY_MM]
        if not len(far):
            continue
        path = [_pick(far, rng)]
        for _ in range(int(rng.integers(1, 4))):
            ends = places[rng.integers(0, len(places), 200)]
            length = np.hypot(ends[:, 0] - path[-1][0], ends[:, 1] - path[-1][1])
            usable = ends[(length > PEOPLE_LEG_MM) & (field.leg_clear_mm(path[-1], ends) > LEG_MM)]
            if len(usable):
                path.append(_pick(usable, rng))
        if len(path) > 1:
            speed, pause, delay = rng.uniform(500, 1300), rng.uniform(0, 10), rng.uniform(0, 20)
            walkers.append(Person(tuple(path), round(speed), pause=round(pause, 1), delay=round(delay, 1)))
    return tuple(walkers)


def _pick(places: Floats, rng: Rng) -> Point:
    x, y = places[int(rng.integers(len(places)))]
    return float(x), float(y)


def without_faults(mission: Mission) -> Mission:
    """Return the same mission, nothing injected: a collision that it has too is not the fault's."""
    return dataclasses.replace(mission, faults=())


def sonar_defaults() -> dict[str, float]:
    """Return the unswept values of what --sensitivity sweeps."""
    plain = SonarParams()
    return {name: float(getattr(plain, name)) for name in SWEEPS}
