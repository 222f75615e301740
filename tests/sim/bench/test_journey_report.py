# SPDX-License-Identifier: MIT
"""Rule: every mission has its line in the CSV, every row of the table its figures, and one picture shows the worst."""

from __future__ import annotations

import csv
import io
import json
from pathlib import Path

import pytest
from bench.journeys import with_ideal
from bench.missions import judged

from hil_sim.bench.journey_figures import summarise
from hil_sim.bench.journey_plots import differs_most
from hil_sim.bench.journey_report import markdown, table, write_report
from hil_sim.errors import SimError

META = {"core": "0" * 64, "split": "judge", "errors": 0}
RECORDS = [
    *with_ideal("argus/judge/rooms/lab/1"),
    *with_ideal("argus/judge/rooms/lab/2", t_s=600.0, collisions=[[3.0, 700.0, 100.0]]),
    *with_ideal("paper/judge/rooms+one+start/lab/2", faults=[judged("off")], faulty=["off:3"]),
]


def test_a_line_for_each_mission() -> None:
    lines = list(csv.DictReader(io.StringIO(table(RECORDS))))
    assert {line["id"] for line in lines} == {record["id"] for record in RECORDS}
    by_id = {line["id"]: line for line in lines}
    assert by_id["argus/judge/rooms/lab/2"]["over_ideal"] == "0.2500"
    assert by_id["argus/judge/rooms/lab/2"]["collisions"] == "1"
    assert by_id["paper/judge/rooms+one+start/lab/2"]["faults"] == "off:3"


def test_the_report_has_each_row_and_says_what_it_is() -> None:
    text = markdown(summarise(RECORDS), META)
    for start in ("| rooms | argus | 2 |", "| rooms | ideal | 2 |", "| rooms+one+start | paper | 1 |"):
        assert start in text
    assert "- `rooms+one+start`: rooms, one fault, from the start" in text
    assert "| rooms: speed over the ideal | >= 0.9 |" in text


@pytest.mark.soak
def test_the_files_are_written_with_a_picture_of_the_worst(tmp_path: Path) -> None:
    text = write_report(tmp_path, RECORDS, META, plots=True)
    assert text.index("- `argus/judge/rooms/lab/2` 0.25, reached after 600 s") < text.index(
        "- `argus/judge/rooms/lab/1` 0.50"
    )
    assert (tmp_path / "journey.md").read_text(encoding="utf-8") == text
    summary = json.loads((tmp_path / "journey.json").read_text(encoding="utf-8"))
    assert [(row["row"], row["driver"]) for row in summary["rows"]] == [
        ("rooms", "ideal"),
        ("rooms", "argus"),
        ("rooms+one+start", "paper"),
    ]
    assert summary["bars"]
    assert differs_most(RECORDS)[0][0]["id"] == "argus/judge/rooms/lab/2"
    svg = (tmp_path / "rooms-argus.svg").read_text(encoding="utf-8")
    told = (
        "Rooms, healthy, nobody about",
        "truly at the goal after 600 s; 150 s without fault and diagnosis",
    )
    for label in (*told, "stop (1)", "look (1)", "collision (1)"):
        assert label in svg, label
    assert (tmp_path / "rooms+one+start-paper.png").stat().st_size > 1000
    assert not (tmp_path / "rooms-ideal.png").exists()


def test_a_folder_that_is_none_is_named(tmp_path: Path) -> None:
    with pytest.raises(SimError, match="name another --out"):
        write_report(tmp_path / "no" / "where", RECORDS, META, plots=False)
