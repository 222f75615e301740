# SPDX-License-Identifier: MIT
"""Rule: figures compare like with like: the same run, at the goal both, each set of dead sonars counted once."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from hil_sim.errors import SimError
from hil_sim.experiment import study, study_pictures, study_tables
from hil_sim.experiment.journey import COLUMNS, read_table, write_table
from hil_sim.tables import load

Record = dict[str, Any]


def record(policy: str, dead: str, t_s: float = 100.0, **more: Any) -> Record:
    """A journey at the goal."""
    fields: Record = {
        "policy": policy, "world": "lab", "seed": 1, "dead": dead, "day": "plain", "word": "reached", "truly": True,
        "course_mm": 7000, "t_s": t_s, "goal_mm": 30, "driven_mm": 7100, "turned_deg": 300, "stops": 3,
        "looking_s": 0.0, "closest_mm": 250, "collisions": 0, "idle_s": t_s, "sonar_s": t_s, "wheel_m": 15.0,
        "accel_j": 8.0, "s1": 0, "s4": 0, "s5": 0, "s7": 0,
    }  # fmt: skip
    return fields | more


def time_of(r: Record) -> float:
    return float(r["t_s"])


def test_a_ratio_is_the_mean_of_the_sets() -> None:
    rows = [
        record("paper", "3", 100), record("adaptive", "3", 20),
        record("paper", "3", 300, seed=2), record("adaptive", "3", 100, seed=2),
        record("paper", "1+2", 200), record("adaptive", "1+2", 100),
    ]  # fmt: skip
    found = study.ratio(rows, "adaptive", "paper", time_of)
    assert found.mean == pytest.approx(0.4)
    assert (found.worst, found.sets, found.runs) == (0.5, 2, 3)


@pytest.mark.parametrize(
    "spoiled",
    [
        {"word": "failed"}, {"truly": False}, {"seed": 2}, {"world": "demo"}, {"day": "rough-day"},
        {"dead": "front"}, {"dead": "none"}, {"dead": "1+2+3+4+5+6"},
    ],
)  # fmt: skip
def test_what_is_not_the_same_run_is_not_compared(spoiled: Record) -> None:
    rows = [record("paper", "3"), record("adaptive", "3") | spoiled]
    if "dead" in spoiled:
        rows[0] |= spoiled
    assert study.ratio(rows, "adaptive", "paper", time_of).runs == 0


def test_energy_is_idle_sonar_wheels_and_acceleration() -> None:
    power = load("energy")["power"]
    one = record("paper", "3")
    rest = 100 * power["sonar_w"] + 15 * power["wheel_j_per_m"] + 8
    for factor in study_tables.IDLE_FACTORS:
        assert study.energy_j(one, factor) == pytest.approx(100 * power["idle_w"] * factor + rest)


def test_one_dead_over_the_healthy_journey() -> None:
    rows = [record("adaptive", "none", 50), record("adaptive", "3", 60), record("adaptive", "1", 80),
            record("adaptive", "2", 80, seed=9), record("adaptive", "1+2", 500)]  # fmt: skip
    found = study.over_healthy(rows, "adaptive")
    assert found.mean == pytest.approx(1.4)
    assert (found.worst, found.runs) == (1.6, 2)


def test_tables_tell_what_was_run() -> None:
    rows = [record("paper", "3", word="failed"), record("adaptive", "3"), record("adaptive", "front", s1=2),
            record("adaptive", "none", day="rough-day", collisions=1)]  # fmt: skip
    assert "| `paper` | 0/1 | - |" in study_tables.goals(rows)
    assert "| `adaptive` | 1/1 | 1/1 |" in study_tables.goals(rows)
    assert "| `adaptive` | 3 | 0.1 | 1 | 1 | 0 | 0 | 0 | 250 |" in study_tables.safety(rows)
    assert "| collisions, all policies | 0 | 1 in 4 journeys |" in study_tables.bars(rows)
    assert "| goals reached, 1 to 5 of six dead | >= 99 % | 1 of 1, 100.0 % |" in study_tables.bars(rows)
    assert "`adaptive` | rough-day | 1 of 66" in study_tables.coverage(rows)
    assert "not run" in study_tables.bars(rows[:1])


def test_a_table_comes_back_as_it_was(tmp_path: Path) -> None:
    rows = [record("paper", "1+2", closest_mm=None, truly=False), record("adaptive", "front", 33.5)]
    write_table(tmp_path / "t.csv", rows)
    back = {r["policy"]: r for r in read_table(tmp_path / "t.csv")}
    assert back == {r["policy"]: r for r in rows}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "is no table"),
        ("a,b\n1,2\n", "is no table"),
        (",".join(COLUMNS) + "\n" + "x," * 23 + "x\n", "damaged"),
    ],
)
def test_a_file_that_is_no_table(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "t.csv").write_text(text, encoding="utf-8")
    with pytest.raises(SimError, match=said):
        read_table(tmp_path / "t.csv")


@pytest.mark.soak
def test_pictures_of_few_results(tmp_path: Path) -> None:
    study_pictures.draw(tmp_path, [record("adaptive", "3"), record("paper", "none", word="failed")])
    assert {path.name for path in tmp_path.iterdir()} == {"journeys.png", "price.png"}
