# SPDX-License-Identifier: MIT
"""Rule: the report has a row for each bar that was asked for, judged on its 95 % bound, and every count is of the
missions it says."""

from __future__ import annotations

import csv
import io
import json
import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from bench.missions import judged, record

from hil_sim.bench.figures import KINDS, readings_wanted, summarise
from hil_sim.bench.report import markdown, table, write_report

META = {"core": "0" * 64, "split": "judge"}
BARS = {
    "found: off, stuck, garbage, slow": ">= 99 %",
    "found: wrong, intermittent": ">= 97 %",
    "kind named correctly when found": ">= 95 %",
    "false disables in 100 fault-free clock hours": "<= 1",
    "latency median in rooms: off, garbage, slow": "<= 2 s",
    "latency p99 in rooms: off, garbage, slow": "<= 10 s",
    "latency median in rooms: silent, stuck, wrong, intermittent": "<= 5 s",
    "latency p99 in rooms: silent, stuck, wrong, intermittent": "<= 30 s",
    "repaired sonar HEALTHY within 60 s of driving": ">= 95 %",
    "collisions attributable to an undetected fault": "0 in 1000 missions",
}


def missions(count: int, kind: str = "off", **more: Any) -> list[dict[str, Any]]:
    return [
        record(f"argus/judge/lab/{seed}/{kind}", faults=[judged(kind, **more)])
        for seed in range(1, count + 1)
    ]


def free(count: int, **more: Any) -> list[dict[str, Any]]:
    return [record(f"argus/judge/lab/{seed}/free", **more) for seed in range(1, count + 1)]


def bars(records: list[dict[str, Any]]) -> dict[str, dict[str, Any]]:
    return {bar["name"]: bar for bar in summarise(records)["profiles"]["argus"]["bars"]}


def verdict(records: list[dict[str, Any]], start: str) -> str:
    return next(str(bar["verdict"]) for name, bar in bars(records).items() if name.startswith(start))


def test_each_bar_has_its_row() -> None:
    assert {name: bar["bar"] for name, bar in bars(missions(1)).items()} == BARS


def test_a_share_passes_on_its_bound_not_on_its_value() -> None:
    assert verdict(missions(299), "found: off") == "pass"
    assert verdict(missions(298), "found: off") == "open"
    assert verdict(missions(298) + missions(4, found=False, latency_s=None), "found: off") == "fail"
    assert verdict(missions(5), "found: wrong") == "open"  # none of these


def test_false_disables_pass_with_300_hours_and_none() -> None:
    wrong = [{"t_s": 1.0, "sonar": 2, "kind": "off"}]
    assert verdict(free(300), "false disables") == "pass"
    assert verdict(free(299), "false disables") == "open"
    assert verdict(free(299) + free(1, false_disables=wrong), "false disables") == "open"
    assert verdict(free(50) + free(1, false_disables=wrong), "false disables") == "fail"


def test_false_disables_beside_a_fault_are_counted_but_not_in_the_fault_free_rate() -> None:
    wrong = [{"t_s": 1.0, "sonar": 2, "kind": "off"}]
    one = summarise([*free(3), *(r | {"false_disables": wrong} for r in missions(2))])["profiles"]["argus"]
    assert (one["false_disables"]["count"], one["false_disables"]["hours"]) == (0, 3.0)
    assert (one["false_disables_with_faults"]["count"], one["false_disables_with_faults"]["hours"]) == (
        2,
        2.0,
    )
    assert one["confusion"]["none"] == {"off": 2}


def test_false_names_are_counted_beside_them() -> None:
    named = [{"t_s": 1.0, "sonar": 2, "kind": "off"}] * 2
    one = summarise(free(4, false_names=named))["profiles"]["argus"]
    assert one["false_names"]["count"] == 8
    assert one["false_names"]["per_100h"] == 200.0


@pytest.mark.parametrize("window_s", [10.0, 30.0])
@pytest.mark.parametrize("crosstalk", [0.01, 0.03])
@pytest.mark.parametrize("pace", [None, 1.0, 2.0])
def test_an_observer_that_errs_once_in_100_h_wants_so_many_readings(
    window_s: float, crosstalk: float, pace: float | None
) -> None:
    windows = 16 * 360_000 / window_s
    fired = int((pace or 1) * window_s / 0.32)

    def deceived(count: int) -> float:
        ways = range(count, fired + 1)
        return windows * sum(
            math.comb(fired, k) * crosstalk**k * (1 - crosstalk) ** (fired - k) for k in ways
        )

    wanted = readings_wanted(window_s, crosstalk, None if pace is None else fired)
    assert deceived(wanted) <= 1 < deceived(wanted - 1)


def test_what_an_observer_of_the_truth_would_find_is_told() -> None:
    late: dict[str, Any] = {"found": False, "latency_s": 50.0}
    records = [
        *missions(4),
        *missions(1, visible_in_time=5, **late),
        *missions(1, visible_in_time=6, **late),
        *missions(1, visible_in_time=2, **late),
        *missions(1, visible_in_time=0),
        *missions(3, "wrong", visible_in_time=7, **late),
        *missions(1, "wrong", visible_in_time=8, **late),
        *missions(9, "wrong", visible_in_time=9, apart="not shown", **late),
        *missions(5, "silent", visible_in_time=0, **late),
    ]
    ideal = summarise(records)["profiles"]["argus"]["ideal"]
    assert (ideal["sure"]["three"]["hits"], ideal["sure"]["once"]["hits"], ideal["sure"]["once"]["of"]) == (
        7,
        6,
        8,
    )
    assert (ideal["hard"]["three"]["hits"], ideal["hard"]["once"]["hits"], ideal["hard"]["once"]["of"]) == (
        4,
        1,
        4,
    )


def test_what_the_peers_alone_would_find_is_told_of_all_and_of_rooms() -> None:
    late: dict[str, Any] = {"found": False, "latency_s": 50.0}
    hall = [one | {"place": "open"} for one in missions(2, contradicted_in_time=5, **late)]
    records = [
        *hall,
        *missions(4, contradicted_in_time=0),
        *missions(1, contradicted_in_time=5, **late),
        *missions(1, contradicted_in_time=6, **late),
        *missions(3, "slow", contradicted_in_time=1, **late),
        *missions(1, contradicted_in_time=7, readings_in_time=62, **late),  # of twice as many
        *missions(3, "wrong", contradicted_in_time=7, **late),
        *missions(2, "silent", contradicted_in_time=8, **late),
    ]
    ideal = summarise(records)["profiles"]["argus"]["ideal"]

    def told(group: str) -> tuple[int, int, int]:
        one = ideal[group]
        return one["measured"]["hits"], one["peers"]["hits"], one["peers"]["of"]

    assert told("sure") == (4, 5, 12)
    assert told("sure_rooms") == told("quick_rooms") == (4, 5, 10)
    assert told("hard") == told("hard_rooms") == (0, 0, 3)
    assert told("slower_rooms") == (0, 2, 5)


def test_when_an_observer_of_the_truth_is_sure_is_told() -> None:
    times = [0.0, 0.4, 0.8, 2.0, 3.0, 4.0, 5.0, 9.0, 9.5]
    records = [
        *missions(3, latency_s=8.0, visible_at=times),  # wants six of 31
        *missions(1, latency_s=8.0, visible_at=times, readings_in_time=62),  # eight of 62
        *missions(1, latency_s=1.0, visible_at=times),  # found sooner
        *missions(1, found=False, latency_s=None, visible_at=times[:5]),  # neither
        *missions(2, "wrong", latency_s=20.0, visible_at=times),  # eight of 93
    ]
    ideal = summarise(records)["profiles"]["argus"]["ideal"]
    assert ideal["quick_rooms"]["once_latency_s"] == {"n": 5, "median": 4.0, "p99": 8.0}
    assert ideal["quick_rooms"]["latency_s"] == {"n": 5, "median": 8.0, "p99": 8.0}
    assert ideal["slower_rooms"]["once_latency_s"] == {"n": 2, "median": 9.0, "p99": 9.0}


def test_what_is_doubted_in_time_is_told_whatever_its_name() -> None:
    late: dict[str, Any] = {"found": False, "latency_s": 50.0}
    records = [
        *missions(4),
        *missions(2, doubted_s=10.0, **late),
        *missions(1, doubted_s=10.1, **late),
        *missions(1, doubted_s=None, **late),
        *missions(9, doubted_s=1.0, apart="ended early", **late),
        *missions(3, "wrong", doubted_s=29.0, **late),
        *missions(2, "wrong", doubted_s=31.0, **late),
        *missions(5, "silent", doubted_s=None, **late),
    ]
    doubted = summarise(records)["profiles"]["argus"]["doubted"]
    assert (doubted["sure"]["hits"], doubted["sure"]["of"]) == (6, 8)
    assert (doubted["hard"]["hits"], doubted["hard"]["of"]) == (3, 5)


def test_collisions_pass_with_none_in_1000_missions() -> None:
    start = "collisions"
    hit = {"collisions": [[1, 2, 3]], "attributable": True}
    assert verdict(free(1000), start) == "pass"
    assert verdict(free(999), start) == "open"
    assert verdict(free(1000) + free(1, **hit, undetected=True), start) == "fail"
    assert (
        verdict(free(1000) + free(1, **hit, undetected=False), start) == "pass"
    )  # the fault was found before


def test_the_confusion_matrix_counts_each_judged_fault_once() -> None:
    records = [
        *missions(3, "slow"),
        *missions(2, "slow", named="wrong", named_right=False),
        *missions(1, "slow", found=False, latency_s=None, named=None, named_right=None),
        *missions(4, "stuck", named="off"),
        *missions(5, "slow", apart="not shown", found=False, named=None),
    ]
    one = summarise(records)["profiles"]["argus"]
    assert one["confusion"]["slow"] == {"slow": 3, "wrong": 2, "not found": 1}
    assert one["confusion"]["stuck"] == {"stuck": 4}  # off, but rightly so
    assert one["kinds"]["slow"]["apart"] == {"not shown": 5}
    assert (one["kinds"]["slow"]["judged"], one["kinds"]["slow"]["never"]) == (6, 1)


def test_latency_is_that_of_rooms() -> None:
    records = [*missions(3), *(r | {"place": "open"} for r in missions(3, latency_s=9.0))]
    row = summarise(records)["profiles"]["argus"]["kinds"]["off"]
    assert (row["latency_s"]["n"], row["latency_s"]["p99"]) == (3, 1.0)
    assert row["latency_s_everywhere"]["p99"] == 9.0


def test_a_failed_mission_is_in_no_figure() -> None:
    records = [*missions(2), {**record("argus/judge/lab/9/off"), "error": "it broke"}]
    assert summarise(records)["profiles"]["argus"]["missions"] == 2
    assert len(table(records).splitlines()) == 3


def test_the_table_has_a_line_for_each_fault_and_each_mission_without() -> None:
    pair = record("argus/judge/lab/1/pair", faults=[judged("off"), judged("slow", sonar=5)])
    rows = list(csv.DictReader(io.StringIO(table([pair, *free(2)]))))
    assert [
        (row["variant"], row["kind"], row["sonar"])
        for row in sorted(rows, key=lambda r: (r["variant"], r["kind"]))
    ] == [
        ("free", "", ""),
        ("free", "", ""),
        ("pair", "off", "3"),
        ("pair", "slow", "5"),
    ]


@pytest.mark.soak
def test_all_files_are_written_and_agree(tmp_path: Path) -> None:
    records = [
        *missions(3),
        *missions(2, "slow", found=False, latency_s=40.0, named="slow"),
        *free(2),
        *(r | {"profile": "paper"} for r in missions(2)),
        *(r | {"sonar": {"noise_mm": 20.0}} for r in missions(2)),
    ]
    text = write_report(tmp_path, records, META, plots=True)
    summary = json.loads((tmp_path / "diagnosis.json").read_text(encoding="utf-8"))
    assert (tmp_path / "diagnosis.md").read_text(encoding="utf-8") == text
    for bar in (*BARS, "## argus", "## paper", "## Sensitivity", *KINDS):
        assert bar in text
    assert summary["profiles"]["argus"]["missions"] == 7
    assert "argus/judge/lab/1/slow" in text.partition("What went wrong")[2]
    for name in ("latency", "confusion", "trade-off", "sensitivity"):
        assert (tmp_path / f"{name}.png").read_bytes().startswith(b"\x89PNG")
        assert "<svg" in (tmp_path / f"{name}.svg").read_text(encoding="utf-8")


@pytest.mark.parametrize("records", [[], [{**record(), "error": "it broke"}]])
def test_nothing_to_report_is_no_error(tmp_path: Path, records: list[dict[str, Any]]) -> None:
    assert "0 missions" in write_report(tmp_path, records, META, plots=True)


def test_every_row_of_a_table_has_the_columns_of_its_head() -> None:
    lines = markdown(
        {"meta": META | {"errors": 0}} | summarise([*missions(3), *missions(2, "wrong"), *free(2)])
    ).splitlines()
    columns = 0
    tables = 0
    for before, line in pairwise(["", *lines]):
        if line.startswith("|"):
            tables += not before.startswith("|")
            columns = columns if before.startswith("|") else line.count("|")
            assert line.count("|") == columns, line
    assert tables == 4


def test_an_hour_is_one_by_the_clock_standing_included() -> None:
    named = [{"t_s": 1.0, "sonar": 2, "kind": "off"}]
    one = summarise(free(2, driving_s=600.0, false_names=named, false_disables=named))["profiles"]["argus"]
    assert one["clock_hours"] == 2.0
    for what in ("false_names", "false_disables"):
        assert (one[what]["hours"], one[what]["per_100h"]) == (2.0, 100.0), what
    assert one["verification"]["verifications_per_h"] == 5.0
