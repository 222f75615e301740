# SPDX-License-Identifier: MIT
"""Rule: all stages run even when one fails, and the end lists what failed with each log; nothing passes by accident."""

from __future__ import annotations

import dataclasses
import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from devtool import stages
from devtool.base import Run, Stop
from devtool.stages import Spent, Stage, StageFailed, logged_runner, making, run_stages, tail_of

FAIL = [sys.executable, "-c", "print('what went wrong'); raise SystemExit(7)"]
PASS = [sys.executable, "-c", "print('fine')"]


@pytest.fixture(autouse=True)
def logs(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    monkeypatch.setattr(stages, "LOGS", tmp_path / "logs")
    return tmp_path / "logs"


def stage(name: str, action: Callable[[Run], str | None]) -> Stage:
    return Stage(name, f"what {name} is about", action)


def passing(run: Run) -> None:
    run(PASS)


def spinning(run: Run) -> None:
    run([sys.executable, "-c", "import time\nwhile time.process_time() < 0.3: pass"])


def failing(run: Run) -> None:
    run(FAIL)


def lacking(_run: Run) -> None:
    raise Stop("this machine lacks something", 3)


def test_all_run_and_the_end_lists_what_failed(logs: Path, capfd: pytest.CaptureFixture[str]) -> None:
    todo = [stage("a", failing), stage("b", passing), stage("c", lacking), stage("d", passing)]
    assert run_stages(todo, keep_going=True, verbose=False) == 1
    said = capfd.readouterr().out
    assert "what went wrong" in said
    assert "not run" not in said
    table, _, failed = said.rpartition("\nfailed: a, c\n")
    for name, word in (("a", "FAILED"), ("b", "ok"), ("c", "FAILED"), ("d", "ok"), ("total", "FAILED")):
        times = r"\d+\.\d s  CPU +\d+\.\d s = +\d+\.\d s tests \+ +\d+\.\d s building"
        assert re.search(rf"^  {name} +{word} +{times}$", table, re.MULTILINE), table
    first, second = failed.splitlines()
    assert first.split()[:2] == ["a", f"{logs / 'a.log'}:"]
    assert "exit code 7" in first
    assert second.split()[:2] == ["c", f"{logs / 'c.log'}:"]
    assert second.endswith("this machine lacks something")
    assert (logs / "d.log").read_text().endswith("fine\n")


def test_it_can_end_with_the_first_that_fails(capfd: pytest.CaptureFixture[str]) -> None:
    assert run_stages([stage("a", failing), stage("b", passing)], keep_going=False, verbose=False) == 1
    assert re.search(r"^  b +not run$", capfd.readouterr().out, re.MULTILINE)


def test_nothing_is_listed_where_all_is_well(capfd: pytest.CaptureFixture[str]) -> None:
    assert run_stages([stage("a", passing), stage("b", lambda run: "a note")], True, False) == 0
    said = capfd.readouterr().out
    assert "failed" not in said.lower()
    assert "a note" in said
    assert "fine" not in said


def meeting(mine: Path, other: Path) -> list[str]:
    """A program that ends well when the other of two has begun, too, and tells how nice it is."""
    code = (
        "import os, sys, time; from pathlib import Path; mine, other = map(Path, sys.argv[1:]); mine.touch()\n"
        "until = time.monotonic() + 300\n"
        "while not other.exists():\n    assert time.monotonic() < until\n    time.sleep(0.02)\n"
        "print('nice', os.nice(0), flush=True)"
    )
    return [sys.executable, "-c", code, str(mine), str(other)]


def test_what_computes_runs_behind_what_waits_for_robots(
    logs: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """Both kinds meet, the results of both are listed in the order of the stages, and a failure of either counts."""
    a, b = tmp_path / "a", tmp_path / "b"
    todo = [
        stage("computes", lambda run: run(meeting(a, b))),
        dataclasses.replace(stage("waits", lambda run: run(meeting(b, a))), real_time=True),
        stage("fails", failing),
        dataclasses.replace(stage("lacks", lacking), real_time=True),
        stage("noted", lambda run: "a note"),
    ]
    assert run_stages(todo, keep_going=True, verbose=False) == 1
    said = capfd.readouterr().out
    table = [line.split()[0] for line in said.splitlines() if " building" in line]
    assert table == ["set-up", "computes", "waits", "fails", "lacks", "noted", "total"]
    assert "failed: fails, lacks\n" in said
    assert "a note" in said
    least = os.nice(0)
    assert f"nice {least}\n" in (logs / "waits.log").read_text()
    assert f"nice {min(19, least + 10)}\n" in (logs / "computes.log").read_text()
    assert os.nice(0) == least


def test_of_what_is_timed_nothing_runs_beside_another(tmp_path: Path) -> None:
    """Nor where the output is to be read, or the first failure ends all."""
    order: list[str] = []
    timed = [
        dataclasses.replace(stage(name, lambda run, name=name: order.append(name)), real_time=True)  # type: ignore[misc]
        for name in "ab"
    ]
    mixed = [*timed, stage("c", lambda run: order.append("c"))]
    assert run_stages(timed, True, False) == 0
    assert run_stages(mixed, True, True) == 0
    assert run_stages(mixed, False, False) == 0
    assert "".join(order) == "ab" + "abc" + "abc"


def test_what_ends_early_beside_is_told() -> None:
    todo = [stage("dies", lambda run: os._exit(1)), dataclasses.replace(stage("b", passing), real_time=True)]
    with pytest.raises(Stop, match="ended without a result"):
        run_stages(todo, True, False)


def test_a_command_that_is_not_there_fails_its_stage_alone(capfd: pytest.CaptureFixture[str]) -> None:
    todo = [stage("a", lambda run: run(["/no/such/program"])), stage("b", passing)]
    assert run_stages(todo, True, False) == 1
    assert "No such file or directory: /no/such/program" in capfd.readouterr().out


def test_what_hangs_is_ended_with_its_children(tmp_path: Path) -> None:
    script = f"sleep 600 & echo $! > {tmp_path / 'pid'}; wait"
    with pytest.raises(StageFailed, match="not done after"):
        logged_runner(tmp_path / "log", False, 1.0)(["sh", "-c", script])
    child = int((tmp_path / "pid").read_text())
    until = time.monotonic() + 300
    while Path(f"/proc/{child}").exists() and not is_dead(child):
        assert time.monotonic() < until, f"process {child} goes on"
        time.sleep(0.05)


def is_dead(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


def test_the_tail_is_of_the_last_command_and_without_what_went_well(tmp_path: Path) -> None:
    log = tmp_path / "log"
    log.write_text("$ one\nof the first\n$ two\n[ 5%] Building x\n 1/9 Test #1: a ... Passed 1 s\nerror: y\n")
    assert tail_of(log) == "$ two\nerror: y"


def test_the_cpu_time_of_a_stage_is_that_of_its_children(logs: Path) -> None:
    result = stages.run_stage(stage("a", spinning), verbose=False)
    assert result.passed
    assert result.spent.cpu_s >= 0.3
    assert result.made == Spent()
    assert result.log == logs / "a.log"


def test_what_building_takes_is_told_apart(capfd: pytest.CaptureFixture[str]) -> None:
    def build_and_test(run: Run) -> None:
        with making():
            spinning(run)
        run(PASS)

    assert run_stages([stage("a", build_and_test)], True, False, Spent(50.0, 20.0)) == 0
    rows = {
        line.split()[0]: [float(number) for number in re.findall(r"(\d+\.\d) s", line)]
        for line in capfd.readouterr().out.splitlines()
        if " building" in line
    }
    assert rows["set-up"] == [50.0, 20.0, 0.0, 20.0]
    assert rows["a"][3] >= 0.3
    assert rows["a"][2] < rows["a"][1] - 0.2
    assert rows["total"] == pytest.approx(
        [mine + others for mine, others in zip(rows["a"], rows["set-up"], strict=True)], abs=0.11
    )


ENDING = """
import sys, time
from pathlib import Path
sys.path.insert(0, {tools!r})
from devtool.base import leave_at_sigterm
from devtool.stages import Stage, run_stages
import devtool.stages as stages
stages.LOGS = Path({logs!r})
leave_at_sigterm()
forever = Stage("a", "runs for ever", lambda run: run([sys.executable, "-c", {child!r}]), real_time={timed})
other = Stage("b", "runs for ever, too", lambda run: run(["sleep", "600"]), real_time=not {timed})
run_stages([forever, other], True, False)
"""
CHILD = """
import sys
sys.path.insert(0, {tools!r})
from devtool.base import leave_at_sigterm
from peers.base import started
leave_at_sigterm()
with started([sys.executable, "-c", {robot!r}]) as robot:
    robot.wait()
"""
ROBOT = """
import os, time
from pathlib import Path
Path({pids!r}).write_text(f"{{os.getppid()}} {{os.getpid()}}")
time.sleep(600)
"""


def lives(process: int) -> bool:
    """Whether a process runs; one that has ended and waits to be fetched does not."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


@pytest.mark.parametrize("timed", [True, False])
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_all_that_a_stage_has_started(number: int, timed: bool, tmp_path: Path) -> None:
    """The robot is in a session of its own, as the peers' runs start it."""
    tools, pids = str(Path(__file__).parents[2] / "tools"), tmp_path / "pids"
    child = CHILD.format(tools=tools, robot=ROBOT.format(pids=str(pids)))
    script = ENDING.format(tools=tools, logs=str(tmp_path / "logs"), child=child, timed=timed)
    words = [sys.executable, "-c", script]
    dev = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    until = time.monotonic() + 300
    while not (pids.exists() and pids.read_text().count(" ")) and time.monotonic() < until:
        time.sleep(0.05)
    started = list(map(int, pids.read_text().split()))
    assert all(map(lives, started))
    dev.send_signal(number)
    assert dev.wait(timeout=300) != 0
    while any(map(lives, started)) and time.monotonic() < until:
        time.sleep(0.05)
    assert not any(map(lives, started))


def test_one_that_does_not_heed_the_signal_is_killed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stages, "GRACE_S", 0.2)
    deaf = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); print(flush=True); time.sleep(600)"
    words = [sys.executable, "-c", deaf]
    child = subprocess.Popen(words, stdout=subprocess.PIPE, start_new_session=True)
    assert child.stdout is not None
    child.stdout.readline()
    stages.end_group(child)
    child.stdout.close()
    assert child.returncode == -signal.SIGKILL
