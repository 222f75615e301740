# SPDX-License-Identifier: MIT
"""Rule: a sonar that gets worse is announced before it is convicted; one that stays as it is, never. What a mission
learnt holds in the next: what had failed comes back on evidence, and only then."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import pytest

from hil_sim.bench.plan import mission_of, parse_id
from hil_sim.sil import Mission, Outcome, run

CASE = "argus/tune/lab/2/free"
LIMIT_S = 500.0


def mission(*faults: str, record: bytes | None = None, limit_s: float = LIMIT_S) -> Mission:
    return replace(mission_of(parse_id(CASE)), faults=faults, record=record, limit_s=limit_s)


@lru_cache(maxsize=1)
def failed() -> Outcome:
    """Return a mission in which a sonar fails: what comes before it is repaired, or is not."""
    return run(mission("off:3@travelled>3000", limit_s=200.0))


def said(outcome: Outcome, name: str, sonar: int) -> list[float]:
    return [event.t_s for event in outcome.events if (event.name, event.sonar) == (name, sonar)]


def drive(seed: int, record: bytes | None, *faults: str) -> Outcome:
    case = mission_of(parse_id(f"argus/tune/office/{seed}/free"))
    return run(replace(case, faults=faults, record=record, limit_s=130.0, stop_at_goal=False))


@pytest.mark.soak
def test_what_gets_worse_over_missions_is_announced_before_it_convicts() -> None:
    record = None
    for mission, p in enumerate((0.05, 0.1, 0.2)):  # seeds 2 to 4
        grown = drive(2 + mission, record, f"intermittent:3:p={p}")
        record = grown.record
        announced = said(grown, "SONAR_DEGRADING", 3)
        assert len(announced) == (mission == 2), f"seed {2 + mission}: {announced}"
        assert said(grown, "SONAR_DISABLED", 3) == [], f"seed {2 + mission}"
        others = {event.sonar for event in grown.events if event.name == "SONAR_DEGRADING"} - {3}
        assert not others, f"seed {2 + mission}"


@pytest.mark.soak
def test_nothing_is_announced_of_healthy_sonars() -> None:
    record = None
    for seed in (2, 3):
        outcome = drive(seed, record)
        record = outcome.record
        assert [e for e in outcome.events if e.name in ("SONAR_DEGRADING", "RECORD_IGNORED")] == [], seed


@pytest.mark.soak
@pytest.mark.parametrize("repaired", [True, False])
def test_what_had_failed_starts_on_probation(repaired: bool) -> None:
    assert failed().final[3] == ("DISABLED", "off")
    after = run(mission(*([] if repaired else ["off:3"]), record=failed().record, limit_s=200.0))
    assert after.health[3][0][1:] == ("PROBATION", "off")
    assert ("HEALTHY" in [health for _, health, _ in after.health[3]]) == repaired
    assert after.reached or not after.collisions
