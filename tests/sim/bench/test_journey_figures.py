# SPDX-License-Identifier: MIT
"""Rule: the speed over the ideal is of the same mission, giving up soon is no speed, and an hour is by the clock."""

from __future__ import annotations

from typing import Any

import pytest
from bench.journeys import journey, with_ideal
from bench.missions import judged

from hil_sim.bench.journey_figures import over_ideal, summarise

NAMED = {"t_s": 1.0, "sonar": 2, "kind": "off"}


def row_of(records: list[dict[str, Any]], driver: str = "argus") -> dict[str, Any]:
    return next(row for row in summarise(records) if row["driver"] == driver)


def test_half_the_speed_is_half_the_ideal() -> None:
    ideal, record = with_ideal()
    assert over_ideal(record, ideal) == pytest.approx(0.5)
    over = row_of([ideal, record])["over_ideal"]
    assert (over["n"], over["ratio"], over["median"], over["worst"]) == (1, 0.5, 0.5, 0.5)
    assert row_of([ideal, record], "ideal")["over_ideal"]["ratio"] == 1.0


def test_the_ratio_is_of_all_way_over_all_time_and_inside_its_interval() -> None:
    records = []
    for seed, t_s in enumerate((150.0, 300.0, 600.0), 1):
        records += with_ideal(f"argus/judge/rooms/lab/{seed}", t_s=t_s)
    over = row_of(records)["over_ideal"]
    assert over["ratio"] == pytest.approx(450 / 1050, abs=1e-3)
    assert over["low"] <= over["ratio"] <= over["high"]
    assert 0.25 <= over["low"] < over["high"] <= 1.0
    assert (over["median"], over["worst"]) == (0.5, 0.25)
    assert over == row_of(records)["over_ideal"]  # drawn from a fixed seed


def test_an_ideal_that_did_not_arrive_is_none() -> None:
    ideal, record = with_ideal()
    lost = ideal | {"word": "running", "progress_mm": 9000.0}
    assert over_ideal(record, lost) is None
    assert row_of([lost, record])["over_ideal"]["n"] == 0
    assert row_of([record])["over_ideal"]["ratio"] is None


def test_who_gives_up_soon_is_counted_with_the_time_of_the_ideal() -> None:
    early: dict[str, Any] = {"word": "failed", "truly": False, "t_s": 15.0, "progress_mm": 4500.0}
    ideal, record = with_ideal(**early)
    assert over_ideal(record, ideal) == pytest.approx(0.1)
    assert row_of([ideal, record])["over_ideal"]["ratio"] == pytest.approx(0.1)
    late = record | {"t_s": 300.0}
    assert over_ideal(late, ideal) == pytest.approx(0.05)


def test_there_by_its_word_is_not_truly_there() -> None:
    records = [
        journey("argus/judge/rooms/lab/1"),
        journey("argus/judge/rooms/lab/2", truly=False, goal_mm=700.0),
        journey("argus/judge/rooms/lab/3", truly=False, word="failed"),
        journey("argus/judge/rooms/lab/4", truly=False, word="running"),
    ]
    row = row_of(records)
    assert (row["truly"]["hits"], row["word"]["hits"], row["gave_up"]["hits"]) == (1, 2, 1)
    assert row["truly"]["of"] == 4
    assert row["truly"]["low"] < 0.25 < row["truly"]["high"]


def test_rates_are_of_clock_hours() -> None:
    row = row_of(
        [
            journey("argus/judge/rooms/lab/1", t_s=900.0, driving_s=100.0, false_names=[NAMED] * 5),
            journey("argus/judge/rooms/lab/2", t_s=900.0, driving_s=100.0, false_disables=[NAMED]),
        ]
    )
    assert row["clock_hours"] == 0.5
    assert row["false_names"]["rate"] == 10.0
    assert row["false_disables"]["rate"] == 2.0
    assert row["false_disables"]["low"] < 2.0 < row["false_disables"]["high"]
    assert (row["stops"]["rate"], row["looks"]["rate"], row["looking_s_per_hour"]) == (48.0, 12.0, 40.0)
    assert row["turned_deg_per_m"] == pytest.approx(3000 / 92, abs=0.05)
    assert row["energy_j_per_m"] == 100.0


def test_collisions_are_missions_and_modes_are_shares() -> None:
    hit = [[3.0, 1.0, 2.0]] * 3
    row = row_of(
        [
            journey("argus/judge/rooms/lab/1", collisions=hit, attributable=True),
            journey("argus/judge/rooms/lab/2", collisions=hit, closest_mm=None),
            journey("argus/judge/rooms/lab/3", closest_mm=55.0),
        ]
    )
    assert (row["collisions"], row["attributable"]) == (2, 1)
    assert row["closest_mm"] == {"n": 2, "least": 55.0, "median": 55.0}
    assert row["modes"] == {"DRIVING": 0.9667, "VERIFYING": 0.0333}


def test_faults_that_hardly_showed_are_set_apart() -> None:
    faults = [judged("off"), judged("slow", found=False, latency_s=None), judged("off", apart="not shown")]
    found = row_of([journey("argus/judge/rooms+two/lab/1", faults=faults)])["found"]
    assert (found["all"]["in_time"]["hits"], found["all"]["ever"]["of"]) == (1, 2)
    assert set(found) == {"all", "off", "slow"}


def test_a_mission_that_failed_to_run_is_in_no_figure() -> None:
    ideal, record = with_ideal()
    broken = {name: record[name] for name in ("driver", "row", "ideal")} | {
        "id": "argus/judge/rooms/lab/2",
        "error": "x",
    }
    assert row_of([ideal, record, broken])["missions"] == 1
