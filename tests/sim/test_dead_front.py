# SPDX-License-Identifier: MIT
"""Rule under attack: a dead front array is found before it matters, and no place is hit twice.

Halls and corridors with a box on the way, walls on no, one or both sides, by the robot's habits and by those of the
vendor's emulator. Where no wall was ever heard nothing can prove that the array is dead: there the rear looks.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from dead_front import Case, cases, drive, healthy, second_hits

DEAD = [case for seed in range(1, 9) for case in cases(["robot", "mobilesim"], [seed])]
WALLED = [case for case in DEAD if case.walls != "none"]
BARE = [case for case in DEAD if case.walls == "none"]


def name(case: Case) -> str:
    """Return what tells a case from the others."""
    return f"{case.kind}-{case.walls}-{case.wall_mm:.0f}-{case.quirks}-{case.seed}"


def test_the_judge_counts_contacts_at_one_place() -> None:
    assert second_hits([]) == 0
    assert second_hits([(0, 0), (0, 301), (0, 602)]) == 0
    assert second_hits([(0, 0), (1000, 0), (0, 299), (1000, 100)]) == 2


def test_the_campaign_has_every_kind() -> None:
    for quirks in ("robot", "mobilesim"):
        kinds = {(case.kind, case.walls) for case in DEAD if case.quirks == quirks}
        assert kinds == {
            *(("hall", walls) for walls in ("none", "left", "right", "both")),
            ("corridor", "both"),
        }
    assert len({case.onset_s for case in DEAD}) >= 6


@pytest.mark.tour(2, 24)
@pytest.mark.parametrize("case", WALLED, ids=name)
def test_beside_a_wall_a_dead_front_touches_nothing(case: Case, tmp_path: Path) -> None:
    seen = drive(case, tmp_path)
    assert seen.hits == 0, seen
    assert not seen.failed, seen


@pytest.mark.tour(1, 8)
@pytest.mark.parametrize("case", BARE, ids=name)
def test_where_nothing_could_prove_it_the_rear_looks(case: Case, tmp_path: Path) -> None:
    seen = drive(case, tmp_path)
    assert seen.hits == 0, seen


@pytest.mark.tour(1, 8)
@pytest.mark.parametrize("case", healthy(["robot", "mobilesim"], range(1, 9)), ids=name)
def test_a_healthy_front_arrives(case: Case, tmp_path: Path) -> None:
    seen = drive(case, tmp_path)
    assert seen.hits == 0, seen
    assert not seen.lost, seen
    assert seen.reached, seen
