# SPDX-License-Identifier: MIT
"""Rule: each obstacle is what its name says, and only the closed room has no way in."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from hil_sim.bench.course import LEG_MM, ROOM_MM
from hil_sim.bench.journey_worlds import FLOORS, NO_WAY, SETS, Place, place_of
from hil_sim.errors import SimError
from hil_sim.tables.robot import robot_table

KEYS = [(0x7A3D, seed) for seed in (1, 2)]
HALF_MM = robot_table().body.half_mm


def places(name: str) -> list[Place]:
    return [place_of(f"{name}-{k}", key) for key in KEYS for k in range(1, 9)]


def straight_clear_mm(place: Place) -> float:
    return float(place.field.leg_clear_mm(place.begins[:2], np.array(place.course[-1:]))[0])


def widest_mm(place: Place, x: float) -> list[float]:
    """The gaps between solids on a line across the world at x."""
    ys = []
    for x1, y1, x2, y2 in place.world.segments.tolist():
        if min(x1, x2) <= x <= max(x1, x2) and x1 != x2:
            ys.append(y1 + (y2 - y1) * (x - x1) / (x2 - x1))
        elif x1 == x2 == x:
            ys += [y1, y2]
    ys.sort()
    return [b - a for a, b in pairwise(ys)]


@pytest.mark.tour(2)
@pytest.mark.parametrize("name", sorted(SETS))
def test_the_goal_can_be_reached_unless_it_is_closed(name: str) -> None:
    for place in places(name):
        spots = place.field.places(ROOM_MM)
        near = bool((np.hypot(*(spots - np.array(place.course[-1])).T) < 80).any())
        assert near == (name != NO_WAY), place.path
        assert float(place.field.at(*np.array(place.begins[:2])[:, None])[0]) >= LEG_MM, place.path


def test_a_door_is_1000_mm_wide_and_the_straight_way_leads_near_it() -> None:
    for place in places("doors"):
        at = sorted({x1 for x1, _, x2, _ in place.world.segments.tolist() if x1 == x2})[1]
        assert 1000.0 in [round(gap) for gap in widest_mm(place, at)], place.path
        (goal,) = place.course
        assert goal[0] > at + 1000, place.path


def test_a_corridor_is_1200_mm_wide() -> None:
    for place in places("corridors"):
        xs = sorted({x1 for x1, _, x2, _ in place.world.segments.tolist() if x1 == x2})
        begin, end = xs[1], xs[2]
        assert end - begin >= 2900, place.path
        assert [round(gap) for gap in widest_mm(place, (begin + end) / 2)] == [1200], place.path


def test_a_dead_end_is_1_5_m_deep_and_on_the_way() -> None:
    for place in places("dead-ends"):
        deep = [
            abs(x2 - x1)
            for x1, y1, x2, y2 in place.world.segments.tolist()
            if y1 == y2 and abs(x2 - x1) == pytest.approx(1500, abs=1)
        ]
        assert len(deep) == 2, place.path
        assert straight_clear_mm(place) < HALF_MM, place.path


@pytest.mark.tour(1)
@pytest.mark.parametrize("name", ["bends", "pairs", NO_WAY])
def test_the_straight_way_is_blocked(name: str) -> None:
    for place in places(name):
        assert straight_clear_mm(place) < LEG_MM, place.path
        if name != "bends":
            assert straight_clear_mm(place) < HALF_MM, place.path


@pytest.mark.parametrize("name", sorted(FLOORS))
def test_a_floor_is_an_aria_map_with_a_long_course(name: str) -> None:
    for key in KEYS:
        place = place_of(name, key)
        assert place.path.endswith(".map")
        assert place.world.about.startswith("ARIA map")
        way = [place.begins[:2], *place.course]
        assert sum(math.dist(a, b) for a, b in pairwise(way)) > 42_000, place.path


def test_an_unknown_world_is_refused() -> None:
    with pytest.raises(SimError, match="no world 'doors-x'"):
        place_of("doors-x", KEYS[0])
