# SPDX-License-Identifier: MIT
"""Rule: the command drives what it was told, keeps what it has when it is interrupted, and says what is wrong in one
line."""

from __future__ import annotations

import json
import signal
import subprocess
import time
from pathlib import Path
from typing import Any

import forks
import pytest

from hil_sim.bench.store import RESULTS
from hil_sim.cli.main import main
from hil_sim.start import EXIT_INTERRUPTED

TINY = ("journey", "--rows", "rooms", "--worlds", "lab", "--profiles", "argus", "--jobs", "1", "--no-plots")


def bench(*words: str) -> int:
    try:
        return main(["bench", *words])
    except SystemExit as left:
        return int(left.code or 0)


@pytest.mark.soak
def test_the_quick_selection(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert bench("journey", "--quick", "--out", str(tmp_path)) == 0
    out, _ = capfd.readouterr()
    summary = json.loads((tmp_path / "journey.json").read_text(encoding="utf-8"))
    rows = {(row["row"], row["driver"]): row for row in summary["rows"]}
    assert {driver for _, driver in rows} == {"ideal", "argus"}
    assert rows["rooms", "ideal"]["over_ideal"]["ratio"] == 1.0
    assert rows["rooms", "ideal"]["looks"]["count"] == 0, "the ideal looks"
    for (row, driver), figures in rows.items():
        assert f"| {row} | {driver} | {figures['missions']} |" in out
        assert figures["attributable"] == 0, (row, driver)
        assert figures["false_disables"]["count"] == 0, (row, driver)
    assert (tmp_path / "rooms-argus.svg").exists()
    assert len((tmp_path / "journey.csv").read_text(encoding="utf-8").splitlines()) == 1 + sum(
        row["missions"] for row in summary["rows"]
    )


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--rows", "nowhere"], "row 'nowhere'"),
        (["--rows", "rooms+rain"], "row 'rooms+rain'"),
        (["--seeds", "3-1"], "'3-1' is no range of seeds"),
        (["--profiles", "nobody"], "profile 'nobody'"),
        (["--worlds", "nowhere"], "--worlds nowhere: matches nothing"),
        (["--one", "argus/tune/office/7/off/1/x"], "is no id of a journey"),
        (["--one", "argus/tune/rooms/nowhere/7"], "nowhere"),
        (
            ["--one", "argus/tune/rooms/lab/7", "--seeds", "1"],
            "--one has its own missions; leave --seeds out",
        ),
        (["--quick", "--rows", "rooms"], "--quick has its own missions; leave --rows out"),
        (["--resume", "--fresh"], "give one of them"),
        (["--jobs", "0"], "'0' is not a number of processes"),
        (["--speed"], "unrecognized arguments"),
    ],
)
def test_wrong_arguments_give_one_line(
    words: list[str],
    said: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert bench("journey", *words) == 2
    out, err = capfd.readouterr()
    assert said in err
    assert (out, err.count("\n")) == ("", 1)
    assert not list(tmp_path.iterdir())


def test_help_has_examples_and_exit_codes(capfd: pytest.CaptureFixture[str]) -> None:
    assert bench("journey", "--help") == 0
    out, _ = capfd.readouterr()
    assert "examples:" in out
    assert "exit codes:" in out


def test_one_prints_the_time_line_and_draws(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    assert bench("journey", "--one", "argus/tune/doors/doors-1/1", "--out", str(tmp_path)) == 0
    *lines, last = capfd.readouterr().out.splitlines()
    assert json.loads(last)["id"] == "argus/tune/doors/doors-1/1"
    assert lines[0].startswith("argus/tune/doors/doors-1/1: world ")
    assert (tmp_path / "doors-argus.svg").exists()


@pytest.mark.soak
def test_resume_runs_what_is_missing_and_nothing_twice(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    words = (*TINY, "--out", str(tmp_path))
    assert bench(*words, "--seeds", "1") == 0
    path = tmp_path / RESULTS
    before = path.read_text(encoding="utf-8").splitlines()
    assert len(before) == 2
    assert bench(*words, "--seeds", "1") == 2
    assert "--resume" in capfd.readouterr().err
    path.write_text(before[0] + "\n" + before[1][:50], encoding="utf-8")
    assert bench(*words, "--seeds", "1", "--resume") == 0
    after = path.read_text(encoding="utf-8").splitlines()
    assert after[0] == before[0]  # wall_s and all: not run again
    assert [same(line) for line in after] == [same(line) for line in before]


def same(line: str) -> dict[str, Any]:
    return {name: value for name, value in json.loads(line).items() if name != "wall_s"}


@pytest.mark.soak
def test_an_interrupt_keeps_what_is_done(tmp_path: Path) -> None:
    words = ("bench", *TINY, "--seeds", "1-400", "--jobs", "2", "--out", str(tmp_path))
    pipe = subprocess.PIPE
    with forks.start("hil_sim.cli.main:main", *words, stdout=pipe, stderr=pipe) as process:
        end = time.monotonic() + 600
        while not (path := tmp_path / RESULTS).exists() or path.read_bytes().count(b"\n") < 1:
            assert process.poll() is None, process.communicate()
            assert time.monotonic() < end
            time.sleep(0.05)
        process.send_signal(signal.SIGTERM)
        out, err = (said.decode() for said in process.communicate(timeout=600))
    assert process.returncode == EXIT_INTERRUPTED, err
    assert out == ""
    assert "--resume goes on" in err
    assert "Traceback" not in err
    for line in path.read_text(encoding="utf-8").splitlines():
        json.loads(line)


def test_a_mission_that_fails_is_told_and_fails_the_bench(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    def broken(case: object) -> None:
        raise RuntimeError("it broke")

    monkeypatch.setattr("hil_sim.bench.journey_track.run_case", broken)
    assert bench(*TINY, "--seeds", "1", "--out", str(tmp_path)) == 1
    err = capfd.readouterr().err
    assert "argus/tune/rooms/lab/1: RuntimeError: it broke" in err
    assert "2 missions failed" in err
