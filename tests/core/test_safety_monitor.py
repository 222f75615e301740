# SPDX-License-Identifier: MIT
"""Rule: the monitor of S1 to S8 finds each rule that is broken in a fault manager, and none in the one that we ship."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Final

import pytest
from mutated import Mutant, Workshop
from watch_missions import MISSIONS, mission_of
from watched import watch

ROOT: Final = Path(__file__).resolve().parents[2]
SEED: Final = 20261127

MUTANTS: Final = (
    Mutant(
        "no-e-stop",
        "bumper",
        frozenset({21}),
        (("supervisor/modes.c", r"(?m)^    if \(command == ARCOS_CMD_E_STOP\) \{", "    if (false) {"),),
    ),
    Mutant(
        "no-stop",
        "cut",
        frozenset({21, 22, 23, 24, 25}),
        (("adjustment/motion.c", r"(?m)^    argus_outbox_urgent\(out, ARCOS_CMD_STOP\);", "    (void)out;"),),
    ),
    Mutant(
        "setv-high",
        "plain",
        frozenset({55}),
        (("adjustment/motion.c", r"ARCOS_CMD_SETV, speed_mm_s", "ARCOS_CMD_SETV, 750"),),
    ),
    Mutant(
        "setv-500",
        "plain",
        frozenset({51}),
        (("adjustment/motion.c", r"ARCOS_CMD_SETV, speed_mm_s", "ARCOS_CMD_SETV, 500"),),
    ),
    Mutant(
        "s1-never-blind",
        "two-silent",
        frozenset({11}),
        (
            ("adjustment/guard.c", r"return out \| argus_guard_alone\(self\);", "return 0u * out;"),
            ("adjustment/guard.c", r"return plan->disabled == 0 \|\| plan->complete;", "return true;"),
            ("adjustment/guard.c", r"return plan->disabled == 0 \|\| \(self->[^;]*;", "return true;"),
        ),
    ),
    Mutant(
        "s2-object",
        "stuck-near",
        frozenset({23, 51, 54}),
        (
            ("awareness/alarms.c", r"range_mm <= config->object_range_mm", "range_mm <= 10"),
            (
                "behaviour/travel.c",
                r"if \(nearest_mm <= self->config.object_range_mm\)",
                "if (nearest_mm <= 10)",
            ),
            (
                "adjustment/guard.c",
                r"argus_max\(0, read_mm\(self\) - self->config->object_range_mm\)",
                "read_mm(self)",
            ),
        ),
    ),
    Mutant(
        "s2-silent",
        "silent",
        frozenset({24}),
        (("awareness/alarms.c", r"return !argus_is_out\(knowledge, sonar\) && [^;]*;", "return false;"),),
    ),
    Mutant(
        "s2-no-sip",
        "cut",
        frozenset({25}),
        (
            ("supervisor/manager.c", r"(?s)(LINK_STALLED, self->config.link_stall_ms\);\n).*?;", r"\1"),
            ("knowledge/latency.c", r"if \(!stands \|\| mine->stands\)", "if (stands || !stands)"),
        ),
    ),
    Mutant(
        "s2-resume",
        "cut",
        frozenset({26}),
        (("arcos/session.c", r"self->zeros_due = 2;", "self->zeros_due = 0;"),),
    ),
    Mutant(
        "s4-not-home",
        "sweeps",
        frozenset({41}),
        (("adjustment/sweep.c", r"plan->count \? 0 :", "plan->count ? 31 * self->index :"),),
    ),
    Mutant(
        "s6-unheard",  # four places wait for all that look ahead: none does
        "never-heard",
        frozenset({61}),
        (
            (
                "knowledge/knowledge.c",
                r"(?m)(^bool argus_all_fresh_since\((?:.|\n)*?\) \{\n)",
                r"\1    return true;\n",
            ),
            ("behaviour/resting.c", r"if \(mine->rounds > 1\)", "if (mine->rounds > 2)"),
            (
                "adjustment/guard.c",
                r"counts && argus_age_ms\(self->knowledge, i, self->now_ms\) > limit_ms",
                "false",
            ),
        ),
    ),
    Mutant(
        "s7-circle",
        "bumper",
        frozenset({72, 73, 74}),
        (
            (
                "adjustment/guard.c",
                r"return argus_guard_nearest_mm\(self, 0\) <= swing_mm\(self\);",
                "return false;",
            ),
            ("adjustment/guard.c", r"(?s)return !is_heard_in_nudge\(.*?;", "return true;"),
        ),
    ),
)


@pytest.fixture(scope="module")
def workshop(tmp_path_factory: pytest.TempPathFactory) -> Workshop:
    return Workshop(tmp_path_factory.mktemp("mutants"))


def drive(library: Path, *names: str) -> dict[str, list[tuple[int, str]]]:
    """Run missions with a fault manager; return what it broke in each."""
    paths = os.pathsep.join(map(str, (ROOT, ROOT / "tools", ROOT / "tests/oracle")))
    command = [sys.executable, str(ROOT / "tests/oracle/watch_missions.py"), str(SEED), *names]
    environment = {**os.environ, "ARGUS_CORE": str(library), "PYTHONPATH": paths}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False, timeout=900)
    assert done.returncode == 0, done.stderr
    found: dict[str, list[tuple[int, str]]] = json.loads(done.stdout)
    return found


@pytest.mark.tour(4, 14)
@pytest.mark.parametrize("mission", MISSIONS)
def test_the_fault_manager_breaks_none(mission: str) -> None:
    _, violations = watch(mission_of(mission, SEED))
    assert not violations, f"seed {SEED}: {list(map(str, violations))}"


@pytest.mark.soak
@pytest.mark.parametrize("mutant", MUTANTS, ids=lambda mutant: mutant.name)
def test_each_broken_rule_is_found(workshop: Workshop, mutant: Mutant) -> None:
    found = drive(workshop.build(mutant), mutant.mission)
    broken = {rule for each in found.values() for rule, _ in each}
    assert broken & mutant.rules, f"seed {SEED}: {found}"
