# SPDX-License-Identifier: MIT
"""What the journeys of the study amount to: figures from its records."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from statistics import mean
from typing import Any, Final

from hil_sim.experiment.cases import ARRAYS, HEALTHY, count_dead
from hil_sim.tables import load

Record = dict[str, Any]
IDLE_FACTORS: Final = (0.5, 1.0, 2.0)
PAPER: Final = "paper"
OURS: Final = "adaptive"
RULES: Final = ("s1", "s4", "s5", "s7")
SOME: Final = ("1", "2", "3", "4", "5")
"""Neither none nor all of the six."""
GROUPS: Final = (HEALTHY, "1", "2", "3", "4", "5", "6", *ARRAYS)
_POWER: Final[Mapping[str, float]] = load("energy")["power"]


def group_of(dead: str) -> str:
    """Return where a set of dead sonars is counted: by how many there are, or as an array."""
    count = count_dead(dead)
    return dead if count is None or count == 0 else str(count)


def energy_j(record: Record, idle: float = 1.0) -> float:
    """Return the energy of a journey, with so much of the idle power."""
    return float(
        record["idle_s"] * _POWER["idle_w"] * idle
        + record["sonar_s"] * _POWER["sonar_w"]
        + record["wheel_m"] * _POWER["wheel_j_per_m"]
        + record["accel_j"]
    )


def run_of(record: Record) -> tuple[Any, ...]:
    """Return what two policies have in common that drive the same run."""
    return record["world"], record["seed"], record["dead"], record["day"]


def arrived(record: Record) -> bool:
    """Whether the robot says that it is at its goal, and truly is."""
    return record["word"] == "reached" and bool(record["truly"])


@dataclass(frozen=True)
class Ratio:
    """A quantity of one policy over that of another, on the runs that both end at the goal: the mean of the sets."""

    mean: float | None
    worst: float | None
    sets: int
    runs: int


def of_sets(pairs: Iterable[tuple[str, float, float]]) -> Ratio:
    """Return the mean over sets of dead sonars of sums over their runs: set, one quantity, and what it is over."""
    sums: dict[str, list[float]] = {}
    runs = 0
    for dead, one, other in pairs:
        runs += 1
        total = sums.setdefault(dead, [0.0, 0.0])
        total[0] += one
        total[1] += other
    ratios = [a / b for a, b in sums.values() if b > 0]
    return Ratio(mean(ratios) if ratios else None, max(ratios, default=None), len(ratios), runs)


def ratio(records: Iterable[Record], of: str, over: str, quantity: Callable[[Record], float]) -> Ratio:
    """Compare two policies on the 62 sets of dead sonars that are neither empty nor whole, on a plain day."""
    some = [r for r in at_goal(records) if group_of(r["dead"]) in SOME]
    base = {run_of(r): r for r in some if r["policy"] == over}
    own = [r for r in some if r["policy"] == of and run_of(r) in base]
    return of_sets((r["dead"], quantity(r), quantity(base[run_of(r)])) for r in own)


def over_healthy(records: Iterable[Record], policy: str) -> Ratio:
    """Compare the journeys with one dead sonar to those of the healthy robot in the same world, seed by seed."""
    own = [r for r in at_goal(records) if r["policy"] == policy]
    healthy = {(r["world"], r["seed"]): float(r["t_s"]) for r in own if r["dead"] == HEALTHY}
    one = [r for r in own if group_of(r["dead"]) == "1" and (r["world"], r["seed"]) in healthy]
    return of_sets((r["dead"], r["t_s"], healthy[r["world"], r["seed"]]) for r in one)


def at_goal(records: Iterable[Record]) -> list[Record]:
    """Return the journeys of a plain day that end at the goal."""
    return [record for record in plain(records) if arrived(record)]


def plain(records: Iterable[Record]) -> list[Record]:
    """Return the journeys of a plain day."""
    return [record for record in records if record["day"] == "plain"]
