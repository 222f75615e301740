# SPDX-License-Identifier: MIT
"""Rule: the command does what it says, keeps what it has, and says what is wrong in one line with code 2."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest

from hil_sim.cli.main import main
from hil_sim.experiment import fig10, plans, table1
from hil_sim.experiment.home import off_deg
from hil_sim.experiment.stage import Stage

ROOT = Path(__file__).resolve().parents[3]
RESULTS = ROOT / "docs" / "samples" / "journeys.csv.gz"


def experiment(*words: str) -> int:
    try:
        return main(["experiment", *words])
    except SystemExit as left:
        return int(left.code or 0)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "what"),
        (("table2",), "table2"),
        (("journey", "--masks", "7"), "'7' is no set of dead sonars"),
        (("journey", "--masks", ","), "names no sonars"),
        (("journey", "--worlds", "moon"), "'moon' is no world"),
        (("journey", "--policies", "brave"), "'brave' is no policy"),
        (("journey", "--seeds", "3-1"), "'3-1' is no range"),
        (("journey", "--one", "x"), "is no id of a journey"),
        (("journey", "--results", "/nowhere.csv"), "/nowhere.csv: cannot read it"),
        (("journey", "--resume", "--fresh"), "--fresh"),
        (("table1", "--doc", "x.md"), "--doc"),
        (("table1", "--one", "x"), "--one is a journey"),
        (("table1", "--seed", "-1"), "'-1'"),
        (("table1", "--pty", "--argusd", "/nowhere/argusd"), "there is no argusd"),
    ],
)
def test_what_is_wrong_is_said(
    words: tuple[str, ...], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert experiment(*words, "--out", str(tmp_path / "out")) == 2
    error = capsys.readouterr().err
    assert said in error
    assert error.count("\n") == 1, error


@pytest.mark.soak
def test_a_study_goes_on_where_it_was(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ("journey", "--worlds", "corridor", "--policies", "adaptive", "--seeds", "1", "--jobs", "1")
    out = ("--out", str(tmp_path))
    assert experiment(*words, *out, "--masks", "3") == 0
    assert experiment(*words, *out, "--masks", "3,4") == 2, "results there are overwritten"
    assert "--resume" in capsys.readouterr().err
    before = (tmp_path / "results.jsonl").read_text(encoding="utf-8")
    assert experiment(*words, *out, "--masks", "3,4", "--resume") == 0
    after = (tmp_path / "results.jsonl").read_text(encoding="utf-8")
    assert after.startswith(before)
    assert [json.loads(line)["dead"] for line in after.splitlines()] == ["3", "4"]
    with (tmp_path / "journeys.csv").open(encoding="utf-8") as file:
        assert [row["dead"] for row in csv.DictReader(file)] == ["3", "4"]
    assert (tmp_path / "price.png").exists()


def test_one_journey_again(capsys: pytest.CaptureFixture[str]) -> None:
    assert experiment("journey", "--one", "adaptive/judge/corridor/1/3/plain") == 0
    first = capsys.readouterr().out
    assert experiment("journey", "--one", "adaptive/judge/corridor/1/3/plain") == 0
    assert capsys.readouterr().out == first
    assert json.loads(first.splitlines()[0])["word"] == "reached"


def test_the_published_table_makes_the_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """The page's tables of the study are those that its table of journeys gives."""
    assert experiment("journey", "--results", str(RESULTS), "--out", str(tmp_path)) == 0
    out = capsys.readouterr().out
    page = (ROOT / "docs" / "experiments.md").read_text(encoding="utf-8")
    parts = out.split(":\n")
    assert len(parts) > 5
    lines = [line for line in out.splitlines() if line.startswith("|")]
    assert lines
    assert [line for line in lines if line not in page] == []


@pytest.mark.parametrize("part", [b"no archive", RESULTS.read_bytes()[:5000]])
def test_a_damaged_archive_is_one_line(
    part: bytes, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "journeys.csv.gz"
    path.write_bytes(part)
    assert experiment("journey", "--results", str(path), "--out", str(tmp_path / "out")) == 2
    error = capsys.readouterr().err
    assert "the archive is damaged" in error
    assert error.count("\n") == 1, error


def test_table1_sees_each_object_with_its_own_sonar() -> None:
    rows = table1.run(Stage(), seed=3, speeds=(100,))
    assert [row.seen_by for row in rows] == [1, 2, 3, 4, 5, 6]
    for row in rows:
        own = row.final_mm[row.sonar]
        others = [mm for number, mm in row.final_mm.items() if number != row.sonar]
        assert 200 <= own <= 270, row
        assert min(others) > own + 100, row


def test_table4_is_the_papers() -> None:
    text = plans.table4(Stage())
    assert text.count(" =") == len(plans.TABLE_IV), text


@pytest.mark.soak
def test_fig9_has_the_sums_of_the_62_sets() -> None:
    found = plans.all_plans(Stage(), ("paper", "fewest"))
    assert [sum(len(plan.rotations) for plan in own) for own in found.values()] == [158, 128]
    assert [sum(plan.turned_deg for plan in own) for own in found.values()] == [9920, 5960]


def test_fig10_stops_each_200_mm_and_finds_the_post_in_a_turn() -> None:
    drive = fig10.run(Stage(), seed=2)
    assert all(185 <= step <= 215 for step in drive.steps_mm), drive.steps_mm
    assert len(drive.stops) >= 7
    assert len(drive.seen.values("OBJECT_CHECKED")) == 1
    for stop in drive.stops:
        assert any(off_deg(look, stop.heading_deg - 20) < 3 for look in stop.looks_deg), stop
