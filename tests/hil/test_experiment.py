# SPDX-License-Identifier: MIT
"""Rule: an experiment says the same of argusd on a pty as of the fault manager under virtual time."""

from __future__ import annotations

from harness import ARGUSD

from hil_sim.experiment import plans, table1
from hil_sim.experiment.stage import Stage

PTY = Stage(ARGUSD)


def test_a_plan_of_table_iv() -> None:
    for policy in ("paper", "adaptive"):
        assert plans.plan_of(PTY, policy, "2+4+5+6") == plans.plan_of(Stage(), policy, "2+4+5+6")


def test_an_object_of_table_i() -> None:
    row = table1.run_one(PTY, 5, 200, seed=2)
    assert row.seen_by == 5, row
    assert 190 <= row.final_mm[5] <= 270, row
    assert min(mm for number, mm in row.final_mm.items() if number != 5) > 400, row
