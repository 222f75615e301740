# SPDX-License-Identifier: MIT
"""Rule: of the tests in real time exactly those are run again that failed while the host was late: once, one alone; one
that fails on a punctual host fails the stage."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from devtool.real_time import core_part, run_in_real_time, worker_count
from devtool.stages import StageFailed
from lateness import emulators_late_ms

from hil_sim.record.truth import TruthRecord

ROOT = Path(__file__).resolve().parents[2]


@dataclass
class Runs:
    """Stands for running pytest: each run ends as the next of `ends` says, (exit code, failed and how late)."""

    report: Path
    ends: list[tuple[int, dict[str, int]] | None]
    commands: list[list[str]] = field(default_factory=list)

    def __call__(self, command: Sequence[str | Path]) -> None:
        assert not self.report.exists(), "what an earlier run found was left for this one"
        self.commands.append([str(word) for word in command])
        end = self.ends.pop(0)
        if end is None:
            raise StageFailed("killed")
        code, failed = end
        self.report.write_text(json.dumps({"exit": code, "failed": failed}))
        if code:
            raise StageFailed(f"exit code {code}")

    def go(self, workers: int = 10) -> str | None:
        return run_in_real_time(self, ["pytest", "-q"], ["tests/hil"], workers, self.report)


@pytest.fixture
def runs(tmp_path: Path) -> Runs:
    report = tmp_path / "host-late.json"
    report.write_text("of an earlier stage")
    return Runs(report, [])


def test_what_passes_is_run_once(runs: Runs) -> None:
    runs.ends = [(0, {})]
    assert runs.go() is None
    assert runs.commands == [["pytest", "-q", "-n", "10", "tests/hil"]]


def test_what_failed_while_the_host_was_late_is_run_once_more_alone(
    runs: Runs, capsys: pytest.CaptureFixture[str]
) -> None:
    runs.ends = [(1, {"a": 300, "b[1-x]": 562}), (0, {})]
    note = runs.go()
    assert runs.commands[1:] == [["pytest", "-q", "-n", "1", "a", "b[1-x]"]]
    assert note is not None
    assert note.endswith("562 ms late: a, b[1-x]")
    said = capsys.readouterr().out
    assert "THE HOST WAS LATE" in said
    assert "562 ms late  b[1-x]" in said
    assert "one at a time" in said


@pytest.mark.parametrize(
    "end",
    [
        (1, {"a": 0}),
        (1, {"a": 300, "b": 0}),
        (2, {"a": 300}),
        (3, {}),
        (1, {}),
        None,
    ],
    ids=["punctual", "one-punctual", "collection", "internal", "nothing-named", "killed"],
)
def test_nothing_else_is_run_again(runs: Runs, end: tuple[int, dict[str, int]] | None) -> None:
    runs.ends = [end]
    with pytest.raises(StageFailed):
        runs.go()
    assert len(runs.commands) == 1


def test_a_failure_on_a_punctual_host_is_named(runs: Runs) -> None:
    runs.ends = [(1, {"a": 300, "b": 0})]
    with pytest.raises(StageFailed, match=r"the host was punctual: b$"):
        runs.go()


def test_what_fails_punctually_when_run_again_fails(runs: Runs) -> None:
    runs.ends = [(1, {"a": 300, "b": 200}), (1, {"b": 0})]
    with pytest.raises(StageFailed, match=r"punctual: b$"):
        runs.go()


def test_a_host_that_is_late_for_a_single_test_fails_the_stage(runs: Runs) -> None:
    runs.ends = [(1, {"a": 300})] * 2
    with pytest.raises(StageFailed, match="even for one test at a time"):
        runs.go()
    assert [command[3] for command in runs.commands] == ["10", "1"]


def test_the_workers_follow_what_the_machine_gives() -> None:
    usual = worker_count(2, 1.0, 0.4)
    assert usual == 11
    slow = worker_count(2, 1.0, 3 * 0.4)
    shared = worker_count(2, 1 / 3, 0.4)
    assert 2 < slow < usual
    assert slow == shared
    assert worker_count(1, 0.1, 2.0) == 2
    assert worker_count(2, 1.0, 0.0) == 14
    assert worker_count(8, 1.0, 0.2) == 56


def test_the_latest_turn_is_found_in_every_truth_record_below_the_folder(tmp_path: Path) -> None:
    assert emulators_late_ms(tmp_path) == 0
    for name, late_ms in (("truth0.jsonl", 120.5), ("drive/truth-2.jsonl", 562.0), ("events.jsonl", 999.0)):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        with TruthRecord(tmp_path / name, {"world": '{"type":"late",'}) as truth:
            truth("state", {"t_s": 1.0, "late_ms": 700.0})
            truth("late", {"t_s": 1.1, "late_ms": late_ms})
    with (tmp_path / "truth0.jsonl").open("a") as cut_off:
        cut_off.write('{"type":"late","t_s":1')
    assert emulators_late_ms(tmp_path) == 562


TESTS = """
import pytest

def test_passes():
    pass

def test_fails():
    assert False

def test_fails_late(tmp_path):
    (tmp_path / "truth.jsonl").write_text('{"type":"late","t_s":1.0,"late_ms":60000.4}\\n')
    assert False

@pytest.fixture
def broken():
    raise ValueError

def test_is_never_begun(broken):
    pass
"""


@pytest.mark.soak
@pytest.mark.parametrize("workers", ["0", "2"])
def test_who_failed_is_reported_with_how_late_the_host_was(tmp_path: Path, workers: str) -> None:
    found = watched(tmp_path, TESTS, workers)
    assert set(found) == {f"test_all.py::test_{name}" for name in ("fails", "fails_late", "is_never_begun")}
    assert found["test_all.py::test_fails_late"] == 60000
    # Less than a minute, not 0: the machine that runs this may be late itself.
    assert found["test_all.py::test_fails"] < 60000


SHARED = """
import ctypes
import pytest

@pytest.fixture(scope="module")
def drive():
    ctypes.PyDLL(None).usleep(900_000)  # and no other thread runs

def test_makes_it(drive):
    pass

def test_asks_about_it(drive):
    assert False

def test_has_its_own():
    assert False
"""


@pytest.mark.soak
def test_what_a_file_shares_was_made_late(tmp_path: Path) -> None:
    found = watched(tmp_path, SHARED, "0")
    asks, own = (found[f"test_all.py::test_{name}"] for name in ("asks_about_it", "has_its_own"))
    assert asks > 800
    assert own < asks


def watched(tmp_path: Path, tests: str, workers: str) -> dict[str, int]:
    """Run these tests and return those that failed, with how late the host was."""
    report = tmp_path / "new/host-late.json"
    (tmp_path / "test_all.py").write_text(tests)
    (tmp_path / "conftest.py").write_text(
        "from pathlib import Path\nfrom lateness import HostWatch\n"
        f"def pytest_configure(config):\n    config.pluginmanager.register(HostWatch(Path({str(report)!r})))\n"
    )
    paths = os.pathsep.join(str(path) for path in (ROOT, ROOT / "tests/hil", ROOT / "tests/tools"))
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-n", workers, "--rootdir", str(tmp_path), "test_all.py"],
        cwd=tmp_path, env=os.environ | {"PYTHONPATH": paths}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    found = json.loads(report.read_text())
    assert (found["exit"], done.returncode) == (1, 1), done.stdout
    failed: dict[str, int] = found["failed"]
    return failed


def test_the_measurement_tells_parts_of_a_core() -> None:
    assert 0.0 < core_part() <= 1.05
