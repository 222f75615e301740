# SPDX-License-Identifier: MIT
"""Algorithm 3 and the least number of stops, worked out from their description in words."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from itertools import combinations
from pathlib import Path

FORWARD = range(1, 7)
POSES = Path(__file__).resolve().parents[2] / "hil_sim" / "tables" / "robots" / "p3dx-sh.toml"


@dataclass(frozen=True)
class Plan:
    """Rotations in the order in which the robot visits them, in degrees, counter-clockwise positive."""

    rotations: tuple[int, ...]

    @property
    def returning_deg(self) -> int:
        """Degrees turned when the robot goes back to its heading after each rotation."""
        return sum(2 * abs(r) for r in self.rotations)

    @property
    def swept_deg(self) -> int:
        """Degrees turned when all rotations are visited in one pass, out to both sides and back."""
        return 2 * (max(0, *self.rotations) - min(0, *self.rotations))


@cache
def bearings() -> dict[int, int]:
    """Degrees at which each sonar is mounted."""
    with POSES.open("rb") as file:
        table = tomllib.load(file)
    return {pose["number"]: pose["heading_deg"] for pose in table["sonar"]["pose"]}


def fault_maps() -> list[frozenset[int]]:
    """The 62 combinations that are neither all healthy nor all disabled."""
    return [frozenset(c) for size in range(1, 6) for c in combinations(FORWARD, size)]


def covered_by(rotation: int, disabled: frozenset[int]) -> dict[int, int]:
    """Which enabled sonar looks where each disabled one looked, after the rotation: disabled -> cover."""
    angle = bearings()
    return {d: e for d in disabled for e in FORWARD if e not in disabled and angle[e] + rotation == angle[d]}


def candidates(disabled: frozenset[int]) -> list[int]:
    """Every turn of one enabled sonar onto one disabled bearing, nearest to 0 first, negative first."""
    angle = bearings()
    turns = {angle[d] - angle[e] for d in disabled for e in FORWARD if e not in disabled}
    return sorted(turns, key=lambda r: (abs(r), r))


def covers_all(rotations: Iterable[int], disabled: frozenset[int]) -> bool:
    """Whether every disabled bearing is looked along at one of the rotations at least."""
    seen: set[int] = set()
    for rotation in rotations:
        seen |= covered_by(rotation, disabled).keys()
    return seen == disabled


def walk(disabled: frozenset[int]) -> Plan:
    """The paper's policy: keep a candidate when it brings a bearing that is not covered yet."""
    missing = set(disabled)
    kept: list[int] = []
    for rotation in candidates(disabled):
        fresh = missing & covered_by(rotation, disabled).keys()
        if fresh:
            kept.append(rotation)
            missing -= fresh
        if not missing:
            break
    assert not missing, disabled
    return Plan(tuple(kept))


def one_pass(rotations: Iterable[int]) -> Plan:
    """Visited negative side outward, then positive side outward."""
    left = sorted((r for r in rotations if r < 0), reverse=True)
    return Plan((*left, *sorted(r for r in rotations if r > 0)))


@cache
def least_turn(disabled: frozenset[int]) -> Plan:
    """Least sweep of every set that covers all, then least count, then least sum, then who comes first."""
    turns = sorted(candidates(disabled))
    sets = [c for n in range(1, len(turns) + 1) for c in combinations(turns, n) if covers_all(c, disabled)]
    plans = [Plan(rotations) for rotations in sets]
    best = min(plans, key=lambda p: (p.swept_deg, len(p.rotations), sum(map(abs, p.rotations)), p.rotations))
    return one_pass(best.rotations)


def fewest(disabled: frozenset[int]) -> Plan:
    """Least count, then least sweep, then least sum, then the ascending list that comes first."""
    turns = candidates(disabled)
    for size in range(1, len(turns) + 1):
        complete = [c for c in combinations(sorted(turns), size) if covers_all(c, disabled)]
        if complete:
            best = min(complete, key=lambda c: (Plan(c).swept_deg, sum(map(abs, c)), c))
            return one_pass(best)
    raise AssertionError(disabled)
