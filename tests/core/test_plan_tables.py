# SPDX-License-Identifier: MIT
"""Rule: over all 62 fault maps the planners give the lists, not only the sums, of the paper's words."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.core import planmodel
from tests.core.planmodel import Plan

ROOT = Path(__file__).resolve().parents[2]
SOURCES = [
    "adjustment/cover.c",
    "adjustment/plan.c",
    "adjustment/policy_cover.c",
    "adjustment/policy_walk.c",
    "adjustment/turns.c",
    "analysis/failure.c",
    "knowledge/angle.c",
    "robot/robot.c",
    "robot/gen_robots.c",
]
PROGRAM = r"""
#include <stdio.h>
#include "adjustment/plan.h"
int main(void) {
    for (int policy = 0; policy <= 2; policy++) {
        for (unsigned mask = 0; mask < 128; mask += 2) {
            const argus_robot_t *const robot = argus_robot_default();
            const argus_plan_t plan = argus_plan(robot, (argus_policy_t)policy, (uint16_t)mask, 0);
            printf("%d %u %u %d %d", policy, mask, plan.disabled, plan.return_each, plan.complete);
            for (int i = 0; i < plan.count; i++) {
                printf(" %d/%u", plan.rotation_deg[i], argus_plan_covering(robot, &plan, plan.rotation_deg[i]));
                for (int d = 1; d <= 6; d++) {
                    printf("/%d", mask >> d & 1 ? argus_plan_cover(robot, &plan, plan.rotation_deg[i], d) : -1);
                }
            }
            printf("\n");
        }
    }
    return 0;
}
"""
POLICIES = ("paper", "fewest", "least-turn")
SUMS = {
    "paper": (158, 9920, 6320),
    "fewest": (128, 8520, 5960),
    "least-turn": (128, 8520, 5960),
}
MODELS: dict[str, Callable[[frozenset[int]], Plan]] = {
    "paper": planmodel.walk,
    "fewest": planmodel.fewest,
    "least-turn": planmodel.least_turn,
}


@dataclass(frozen=True)
class Row:
    """What the firmware plans for one fault map."""

    plan: Plan
    map_in_plan: int
    return_each: bool
    complete: bool
    covering: tuple[int, ...]
    cover: tuple[tuple[int, ...], ...]


Table = dict[tuple[str, frozenset[int]], Row]


def mask_of(disabled: frozenset[int]) -> int:
    """The bit mask of a set of sonars."""
    return sum(1 << d for d in disabled)


@pytest.fixture(scope="module")
def table(tmp_path_factory: pytest.TempPathFactory) -> Table:
    """Compile the planner into a program of its own and read what it plans for all 64 maps."""
    folder = tmp_path_factory.mktemp("plan")
    (folder / "main.c").write_text(PROGRAM, encoding="utf-8")
    firmware = ROOT / "firmware"
    sources = [firmware / name for name in SOURCES]
    subprocess.run(
        [
            "gcc",
            "-std=c11",
            "-I",
            firmware,
            "-I",
            firmware / "include",
            "-o",
            folder / "plan",
            folder / "main.c",
            *sources,
        ],
        check=True,
    )
    text = subprocess.run([str(folder / "plan")], check=True, stdout=subprocess.PIPE, text=True).stdout
    rows: Table = {}
    for line in text.splitlines():
        policy, mask, own, each, complete, *stops = line.split()
        disabled = frozenset(d for d in planmodel.FORWARD if int(mask) >> d & 1)
        parts = [[int(part) for part in stop.split("/")] for stop in stops]
        rows[POLICIES[int(policy)], disabled] = Row(
            plan=Plan(tuple(p[0] for p in parts)),
            map_in_plan=int(own),
            return_each=each == "1",
            complete=complete == "1",
            covering=tuple(p[1] for p in parts),
            cover=tuple(tuple(p[2:]) for p in parts),
        )
    assert len(rows) == 192
    return rows


def expected(policy: str, disabled: frozenset[int]) -> Plan:
    """The model's plan."""
    return MODELS[policy](disabled)


def test_there_are_62_maps() -> None:
    assert len(planmodel.fault_maps()) == 62


@pytest.mark.parametrize("policy", POLICIES)
def test_model_gives_the_sums_of_the_paper(policy: str) -> None:
    plans = [expected(policy, d) for d in planmodel.fault_maps()]
    sums = (
        sum(len(p.rotations) for p in plans),
        sum(p.returning_deg for p in plans),
        sum(p.swept_deg for p in plans),
    )
    assert sums == SUMS[policy]


@pytest.mark.parametrize("policy", POLICIES)
def test_firmware_gives_the_sums_of_the_paper(table: Table, policy: str) -> None:
    plans = [table[policy, d].plan for d in planmodel.fault_maps()]
    sums = (
        sum(len(p.rotations) for p in plans),
        sum(p.returning_deg for p in plans),
        sum(p.swept_deg for p in plans),
    )
    assert sums == SUMS[policy]


@pytest.mark.parametrize("policy", POLICIES)
def test_every_list_in_its_order(table: Table, policy: str) -> None:
    differing = {
        tuple(sorted(d)): (table[policy, d].plan.rotations, expected(policy, d).rotations)
        for d in planmodel.fault_maps()
        if table[policy, d].plan != expected(policy, d)
    }
    assert differing == {}  # map: (firmware, model)


@pytest.mark.parametrize(
    ("policy", "disabled", "rotations"),
    [
        ("paper", {3}, (-20,)),
        ("paper", {2, 4, 5, 6}, (-20, -40, -60)),
        ("fewest", {1, 2, 3}, (60,)),
        ("paper", {1, 2, 3}, (20, 40, 60)),
        ("fewest", {3}, (-20,)),
        ("fewest", {2, 3}, (40,)),
    ],
)
def test_table_iv(table: Table, policy: str, disabled: set[int], rotations: tuple[int, ...]) -> None:
    assert table[policy, frozenset(disabled)].plan.rotations == rotations


def test_table_iv_row_2_has_both_turns(table: Table) -> None:
    """The paper lists +20 first; the walk's tie rule visits -20 first."""
    assert set(table["paper", frozenset({2, 3})].plan.rotations) == {20, -20}


@pytest.mark.parametrize(
    ("disabled", "rotation", "pairs"),
    [
        ({3}, -20, {3: 2}),
        ({2, 3}, 20, {3: 4}),
        ({2, 3}, -20, {2: 1}),
        ({2, 4, 5, 6}, -20, {2: 1, 4: 3}),
        ({2, 4, 5, 6}, -40, {5: 3}),
        ({2, 4, 5, 6}, -60, {6: 3}),
    ],
)
def test_table_iv_names_the_covers(
    table: Table, disabled: set[int], rotation: int, pairs: dict[int, int]
) -> None:
    row = table["paper", frozenset(disabled)]
    cover = row.cover[row.plan.rotations.index(rotation)]
    assert {d: cover[d - 1] for d in pairs} == pairs


@pytest.mark.parametrize("policy", POLICIES)
def test_every_cover_looks_along_the_disabled_bearing(table: Table, policy: str) -> None:
    """By the pose table: mounting angle of the cover + rotation = mounting angle of the disabled sonar."""
    angle = planmodel.bearings()
    for disabled in planmodel.fault_maps():
        row = table[policy, disabled]
        seen: set[int] = set()
        for rotation, covering, cover in zip(row.plan.rotations, row.covering, row.cover, strict=True):
            pairs = {d: cover[d - 1] for d in disabled if cover[d - 1] >= 0}
            assert pairs == planmodel.covered_by(rotation, disabled), (sorted(disabled), rotation)
            assert all(angle[e] + rotation == angle[d] for d, e in pairs.items())
            assert covering == mask_of(frozenset(pairs.values())), (sorted(disabled), rotation)
            seen |= pairs.keys()
        assert seen == disabled


@pytest.mark.parametrize("policy", POLICIES)
def test_flags_of_every_plan(table: Table, policy: str) -> None:
    for disabled in planmodel.fault_maps():
        row = table[policy, disabled]
        assert row.complete
        assert row.return_each == (policy == "paper")
        assert row.map_in_plan == mask_of(disabled)


@pytest.mark.parametrize("policy", POLICIES)
def test_nothing_to_plan(table: Table, policy: str) -> None:
    assert table[policy, frozenset()].plan.rotations == ()
    assert table[policy, frozenset(planmodel.FORWARD)].plan.rotations == ()
    assert not table[policy, frozenset(planmodel.FORWARD)].complete


def test_least_turn_plans_what_fewest_plans(table: Table) -> None:
    """Over sonars 1 to 6 the least turning needs no more stops: docs/experiments.md drives one for both."""
    for disabled in [frozenset[int](), *planmodel.fault_maps(), frozenset(planmodel.FORWARD)]:
        assert table["least-turn", disabled] == table["fewest", disabled], sorted(disabled)
