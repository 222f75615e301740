# SPDX-License-Identifier: MIT
"""Rule: with any sonar of the ring left the plan is complete, and no other set of rotations costs less."""

from __future__ import annotations

import random
import subprocess
from pathlib import Path

import pytest

from tests.core.test_plan_tables import ROOT, SOURCES

SEED = 28
ALL = 1 << 16
# Tries every set of up to six turns, since more never see more than one bearing each. Of a set it takes the shortest
# way round through all headings: once around, or there and back leaving out the widest gap.
PROGRAM = r"""
#include <stdio.h>
#include <stdlib.h>
#include "adjustment/plan.h"
#include "adjustment/policy_cover.h"
static const int at[16] = {90, 50, 30, 10, -10, -30, -50, -90, -90, -130, -150, -170, 170, 150, 130, 90};
static const int stop_cost[5] = {0, 1000, 1, 1000, 60}, degree_cost[5] = {0, 1, 1000, 1, 1};
static int turn[64], sees[64], turns, rule;
static long best;

// `set`: 1 to 359, ascending.
static int way_deg(const int *set, int n) {
    int gap = set[0];
    for (int i = 1; i < n; i++) {
        gap = set[i] - set[i - 1] > gap ? set[i] - set[i - 1] : gap;
    }
    gap = 360 - set[n - 1] > gap ? 360 - set[n - 1] : gap;
    return gap > 180 ? 2 * (360 - gap) : 360;
}

static void add(int from, int *set, int n, int seen, int all) {
    if (n > 0 && seen == all) {
        const long cost = (long)n * stop_cost[rule] + (long)way_deg(set, n) * degree_cost[rule];
        best = cost < best ? cost : best;
        return; // one more stop never makes it cheaper
    }
    for (int i = from; i < turns && n < 6; i++) {
        set[n] = turn[i];
        add(i + 1, set, n + 1, seen | sees[i], all);
    }
}

static void list(unsigned dead, unsigned who) {
    turns = 0;
    for (int t = 1; t < 360; t++) {
        int seen = 0;
        for (int d = 1; d <= 6; d++) {
            for (int by = 0; by < 16; by++) {
                const int looks = dead >> d & 1 && !(dead >> by & 1) && who >> by & 1;
                seen |= looks && (at[by] + t - at[d] + 720) % 360 == 0 ? 1 << d : 0;
            }
        }
        if (seen != 0) {
            turn[turns] = t;
            sees[turns++] = seen;
        }
    }
}

// What the firmware's own list shows and costs: every pair from its own answers, each checked here.
static long priced(const argus_plan_t *plan, unsigned dead, unsigned who) {
    const argus_robot_t *const robot = argus_robot_default();
    int set[6], seen = 0, last = 0, way = 0;
    for (int i = 0; i < plan->count; i++) {
        const int r = plan->rotation_deg[i];
        for (int d = 1; d <= 6; d++) {
            const int by = dead >> d & 1 ? argus_plan_cover(robot, plan, (int16_t)r, d) : -1;
            if (by >= 0 && (dead >> by & 1 || !(who >> by & 1) || (at[by] + r - at[d] + 720) % 360 != 0 ||
                            !(argus_plan_covering(robot, plan, (int16_t)r) >> by & 1))) {
                return -1;
            }
            seen |= by >= 0 ? 1 << d : 0;
        }
        set[i] = r;
    }
    for (int i = 0; i <= plan->count; i++) { // turned the shorter way, home in the end
        const int step = abs((i < plan->count ? set[i] : 0) - last) % 360;
        way += step > 180 ? 360 - step : step;
        last = i < plan->count ? set[i] : 0;
    }
    return seen == (int)(dead & 0x7E) ? (long)plan->count * stop_cost[rule] + (long)way * degree_cost[rule] : -2;
}

int main(int argc, char **argv) {
    unsigned dead;
    unsigned long most = 0;
    rule = argc > 1 ? atoi(argv[1]) : ARGUS_POLICY_RING;
    const unsigned who = rule < ARGUS_POLICY_RING ? 0x7E : 0xFFFF;
    while (scanf("%u", &dead) == 1) {
        const argus_plan_t plan = argus_plan(argus_robot_default(), (argus_policy_t)rule, (argus_mask_t)dead,
                                             (argus_mask_t)~dead);
        int set[6];
        best = 1L << 40;
        list(dead, who);
        add(0, set, 0, 0, (int)(dead & 0x7E));
        const int want = (dead & 0x7E) == 0 || (~dead & who) != 0;
        const long paid = (dead & 0x7E) != 0 && plan.complete ? priced(&plan, dead, who) : 0;
        if (plan.complete != want || (paid != 0 && paid != best)) {
            printf("%04x complete %d, wanted %d; costs %ld, least %ld\n", dead, plan.complete, want, paid, best);
        }
        argus_turns_t all;
        argus_plan_t anew = {.disabled = plan.disabled, .looks = plan.looks};
        argus_turns_of(&all, argus_robot_default(), &anew);
        const unsigned long steps = all.blinds == 0 ? 0 : argus_policy_cover(&anew, &all, 1, 1);
        most = steps > most ? steps : most;
    }
    printf("steps %lu\n", most);
    return 0;
}
"""


@pytest.fixture(scope="module")
def judge(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The program that compares the planner with every set of turns."""
    folder = tmp_path_factory.mktemp("ring")
    (folder / "main.c").write_text(PROGRAM, encoding="utf-8")
    firmware = ROOT / "firmware"
    sources = [firmware / name for name in SOURCES]
    include = ["-I", str(firmware), "-I", str(firmware / "include")]
    output = ["-o", str(folder / "judge"), str(folder / "main.c"), *map(str, sources)]
    subprocess.run(["gcc", "-std=c11", "-O2", *include, *output], check=True)
    return folder / "judge"


def differing(judge: Path, policy: int, masks: list[int]) -> tuple[list[str], int]:
    """Return the masks at which planner and trial differ, and the most steps that the planner took."""
    given = " ".join(map(str, masks))
    text = subprocess.run(
        [str(judge), str(policy)], input=given, check=True, stdout=subprocess.PIPE, text=True
    )
    *lines, last = text.stdout.splitlines()
    return lines, int(last.split()[1])


@pytest.mark.parametrize("policy", [1, 2], ids=["fewest", "least-turn"])
def test_no_set_of_turns_of_the_six_costs_less(judge: Path, policy: int) -> None:
    """All 64 maps; what the other ten do does not count."""
    assert differing(judge, policy, [mask | ten for mask in range(0, 128, 2) for ten in (0, 0xFF81)])[0] == []


@pytest.mark.parametrize("policy", [3, 4], ids=["ring", "adaptive"])
def test_no_set_of_turns_of_the_ring_costs_less(judge: Path, policy: int) -> None:
    masks = [*random.Random(SEED).sample(range(ALL), 500), 0x7E, 0xFF, 0xFFFF, 0xFFFE, 0x7FFF, 0xFEFF]
    lines, steps = differing(judge, policy, masks)
    assert lines == [], f"seed {SEED}"
    assert 0 < steps <= 20_000  # ARGUS_COVER_STEPS_MAX


@pytest.mark.soak
@pytest.mark.parametrize("policy", [3, 4], ids=["ring", "adaptive"])
def test_all_65536_maps(judge: Path, policy: int) -> None:
    lines, steps = differing(judge, policy, list(range(ALL)))
    assert lines == []
    assert 0 < steps <= 20_000
