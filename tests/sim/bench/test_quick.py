# SPDX-License-Identifier: MIT
"""Rule: the diagnosis is no worse than the checked-in bounds; a bound that is broken is named."""

from __future__ import annotations

from pathlib import Path

import pytest
from bench.missions import judged, record

from hil_sim.bench import quick
from hil_sim.bench.cli import main
from hil_sim.bench.figures import summarise
from hil_sim.bench.plan import parse_id
from hil_sim.bench.quick import broken, cases, load_bounds
from hil_sim.errors import SimError

SOME = {"argus": ("office", "gen-corridor"), "paper": ("lab",)}


@pytest.mark.soak
def test_two_worlds_are_within_the_bounds_of_all(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    some = [
        case
        for case in cases()
        if case.world in SOME[case.profile] and (case.profile == "argus" or case.kind in ("off", "silent"))
    ]
    bounds = load_bounds()
    # Two missions of a kind are no rate: of the kinds, the bound of all of them together holds.
    argus = {name: value for name, value in bounds["argus"].items() if name != "found"} | {"missions": 18}
    paper = {"missions": 2, **{name: bounds["paper"][name] for name in ("found", "attributable")}}
    monkeypatch.setattr(quick, "cases", lambda: some)
    monkeypatch.setattr(quick, "load_bounds", lambda: {"argus": argus, "paper": paper})
    assert main(["diagnosis", "--quick", "--no-plots"]) == 0, capfd.readouterr().err


@pytest.mark.wide
def test_the_quick_bench_is_within_its_bounds(capfd: pytest.CaptureFixture[str]) -> None:
    code = main(["diagnosis", "--quick", "--no-plots"])
    out, err = capfd.readouterr()
    assert code == 0, err
    assert "## argus" in out
    assert "## paper" in out


def test_the_bounds_are_of_the_missions_that_run() -> None:
    bounds = load_bounds()
    for profile, wanted in bounds.items():
        assert wanted["missions"] == sum(case.profile == profile for case in cases())


def test_a_broken_bound_is_named() -> None:
    wrong = [{"t_s": 1.0, "sonar": 2, "kind": "off"}]
    records = [
        record("argus/tune/lab/1/off", faults=[judged("off")]),
        record("argus/tune/lab/2/off", faults=[judged("off", found=False, latency_s=None)]),
        record("argus/tune/lab/1/free", false_disables=wrong),
    ]
    summary = summarise(records)
    held = {"missions": 3, "found": {"off": 0.5}, "named": 1.0, "false_disables": 1, "attributable": 0}
    assert broken(summary, {"argus": held}) == []
    for name, value, line in (
        ("missions", 4, "argus: missions is 3, must be 4"),
        ("found", {"off": 0.51}, "argus: found of off is 0.5, must be at least 0.51"),
        ("found", {"slow": 0.1}, "argus: found of slow: nothing to judge"),
        ("found_all", 0.6, "argus: found_all is 0.5, must be at least 0.6"),
        ("rehabilitated", 0.1, "argus: rehabilitated: nothing to judge"),
        ("false_disables", 0, "argus: false_disables is 1, must be at most 0"),
    ):
        assert broken(summary, {"argus": held | {name: value}}) == [line]
    assert broken(summary, {"paper": {}}) == ["paper: no mission ran"]


def test_a_broken_bound_fails_the_command(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(quick, "cases", lambda: [parse_id("argus/tune/lab/1/off")])
    monkeypatch.setattr(quick, "load_bounds", lambda: {"argus": {"missions": 2, "undetected": 0}})
    assert main(["diagnosis", "--quick", "--no-plots", "--jobs", "1"]) == 1
    err = capfd.readouterr().err
    assert "argus-sim: argus: missions is 1, must be 2\n" in err
    assert "1 of the bounds in bounds.toml broken" in err


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("argus = 3", "'argus' is no table"),
        ("[argus]\nspeed = 3", "speed is no bound"),
        ("[argus]\nmissions = 'x'", "missions is no number"),
        ("[argus]\nfound = 3", "found is no number"),
        ("[argus.found]\nbroken = 3", "found: there are"),
        ("[argus", "not TOML"),
    ],
)
def test_a_wrong_file_of_bounds_is_told_in_a_line(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "bounds.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(SimError, match=said):
        load_bounds(path)
    with pytest.raises(SimError, match="cannot read"):
        load_bounds(tmp_path / "none.toml")
