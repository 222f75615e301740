# SPDX-License-Identifier: MIT
"""Rule: the command says in one line what is wrong with what it was given, and goes on where it was interrupted
without running anything twice."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import time
from pathlib import Path

import forks
import pytest

from hil_sim.bench import runner
from hil_sim.bench.store import META, RESULTS
from hil_sim.cli.main import main
from hil_sim.core.library import LIBRARY_VARIABLE
from hil_sim.start import EXIT_INTERRUPTED

TINY = ("--worlds", "lab", "--kinds", "off,garbage", "--profiles", "argus", "--jobs", "1", "--no-plots")


def bench(*words: str) -> int:
    try:
        return main(["bench", *words])
    except SystemExit as left:
        return int(left.code or 0)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([], "name one of diagnosis"),
        (["navigation"], "no bench 'navigation'; name one of diagnosis"),
        (["journeyx"], "did you mean journey? name one of diagnosis"),
        (["diagnosis", "--seeds", "3-1"], "'3-1' is no range of seeds"),
        (["diagnosis", "--seeds", "x"], "'x' is no range of seeds"),
        (["diagnosis", "--kinds", "off,broken"], "'broken' is no kind"),
        (["diagnosis", "--profiles", "nobody"], "profile 'nobody'"),
        (["diagnosis", "--profiles", "argus:step_mm"], "'step_mm' is no setting"),
        (["diagnosis", "--worlds", "nowhere"], "--worlds nowhere: matches nothing"),
        (["diagnosis", "--jobs", "0"], "'0' is not a number of processes"),
        (["diagnosis", "--one", "argus/tune/office/7/broken"], "is no id of a mission"),
        (["diagnosis", "--one", "argus/tune/nowhere/7/off"], "nowhere"),
        (["diagnosis", "--one", "argus/tune/office/7/off", "--seeds", "1-2"], "--one has its own missions"),
        (["diagnosis", "--quick", "--worlds", "lab"], "--quick has its own missions; leave --worlds out"),
        (["diagnosis", "--quick", "--one", "argus/tune/office/7/off"], "leave --quick out"),
        (["diagnosis", "--resume", "--fresh"], "give one of them"),
        (["diagnosis", "--speed"], "unrecognized arguments"),
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
    assert bench(*words) == 2
    out, err = capfd.readouterr()
    assert said in err
    assert (out, err.count("\n")) == ("", 1)
    assert not list(tmp_path.iterdir())


def test_help_tells_the_exit_codes(capfd: pytest.CaptureFixture[str]) -> None:
    assert bench("diagnosis", "--help") == 0
    out, _ = capfd.readouterr()
    assert "exit codes:" in out
    assert "examples:" in out


def test_one_prints_the_time_line_and_the_record(capfd: pytest.CaptureFixture[str]) -> None:
    assert bench("diagnosis", "--one", "argus/tune/lab/2/off") == 0
    *lines, last = capfd.readouterr().out.splitlines()
    record = json.loads(last)
    assert record["id"] == "argus/tune/lab/2/off"
    assert lines[0].startswith("argus/tune/lab/2/off: world lab")
    assert any("FAULT" in line and "begins" in line for line in lines)
    assert any(line.startswith("judged: sonar ") for line in lines)


def test_a_reader_that_leaves_is_no_error() -> None:
    words = ("bench", "diagnosis", "--one", "argus/tune/lab/2/off")
    pipe = subprocess.PIPE
    with forks.start("hil_sim.cli.main:main", *words, stdout=pipe, stderr=pipe) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        err = process.stderr.read()
    assert (process.returncode, err) == (0, b"")


@pytest.mark.soak
def test_resume_runs_what_is_missing_and_nothing_twice(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    words = ("diagnosis", *TINY, "--kinds", "off,garbage,stuck", "--out", str(tmp_path))
    assert bench(*words, "--seeds", "1") == 0
    path = tmp_path / RESULTS
    whole = path.read_text(encoding="utf-8").splitlines()
    assert len(whole) == 3
    assert bench(*words, "--seeds", "1") == 2  # there are results
    assert "--resume" in capfd.readouterr().err

    path.write_text("\n".join([whole[0], whole[1][:100]]), encoding="utf-8")
    assert bench(*words, "--seeds", "1", "--resume") == 0
    again = path.read_text(encoding="utf-8").splitlines()
    assert again[0] == whole[0]  # wall_s and all: not run again
    assert [strip(line) for line in again] == [strip(line) for line in whole]

    meta = json.loads((tmp_path / META).read_text(encoding="utf-8"))
    (tmp_path / META).write_text(json.dumps(meta | {"core": "another"}), encoding="utf-8")
    assert bench(*words, "--seeds", "1", "--resume") == 2
    assert "another build" in capfd.readouterr().err


def strip(line: str) -> dict[str, object]:
    return {name: value for name, value in json.loads(line).items() if name != "wall_s"}


@pytest.mark.tour(1)
@pytest.mark.parametrize(("jobs", "number"), [("1", signal.SIGTERM), ("2", signal.SIGINT)])
def test_an_interrupt_keeps_what_is_done_and_ends_with_130(tmp_path: Path, jobs: str, number: int) -> None:
    words = ("bench", "diagnosis", *TINY, "--seeds", "1-400", "--jobs", jobs, "--out", str(tmp_path))
    pipe = subprocess.PIPE
    with forks.start("hil_sim.cli.main:main", *words, stdout=pipe, stderr=pipe) as process:
        end = time.monotonic() + 600
        while not (path := tmp_path / RESULTS).exists() or path.read_bytes().count(b"\n") < 2:
            assert process.poll() is None, process.communicate()
            assert time.monotonic() < end
            time.sleep(0.05)
        process.send_signal(number)
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

    monkeypatch.setattr("hil_sim.bench.work.run_case", broken)
    assert bench("diagnosis", *TINY, "--seeds", "1", "--out", str(tmp_path)) == 1
    err = capfd.readouterr().err
    assert "argus/tune/lab/1/off: RuntimeError: it broke" in err
    assert "2 missions failed" in err


def test_the_fault_manager_stays_the_same_file_during_a_bench() -> None:
    before = os.environ.get(LIBRARY_VARIABLE)
    with runner.fixed_core() as digest:
        assert os.environ[LIBRARY_VARIABLE] != before
        assert len(digest) == 64
    assert os.environ.get(LIBRARY_VARIABLE) == before
