# SPDX-License-Identifier: MIT
"""Rule: the command says in one line what is wrong with its arguments, its exit code is the judge's verdict, and
no program it started outlives it."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import forks
import pytest
import yaml
from demo_drive import FAULTS, WAYPOINTS, Record, made_up, named

import hil_sim.demo.cli as program
from hil_sim.demo.judge import Injected
from hil_sim.demo.runner import ENDING, CannotStart, Recording, Setup

ROOT = Path(__file__).parents[2]
ROOM = ("--world", "demo")  # the made-up drive is one through it


class Played:
    """Stands in for a run: shows the made-up drive and gives it back."""

    doctor: Callable[[list[Record], list[Record]], None] | None = None
    setup: Setup
    raises: BaseException | None = None

    def __init__(self, setup: Setup, watch: Callable[[Recording], None]) -> None:
        type(self).setup = setup
        self.watch = watch
        self.notes: list[str] = []

    def __call__(self) -> Recording:
        if self.raises is not None:
            raise self.raises
        truth, events = made_up()
        if self.doctor is not None:
            self.doctor(truth, events)
        recording = Recording(truth, events, "goal reached", 1.0, truth[-1]["t_s"])
        self.watch(recording)
        return recording


@pytest.fixture
def played(monkeypatch: pytest.MonkeyPatch) -> type[Played]:
    class Fresh(Played):
        pass

    monkeypatch.setattr(program, "Run", Fresh)
    return Fresh


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Drawing takes most of what a made-up drive takes; whoever asks nothing of the picture gets none."""
    monkeypatch.setattr("hil_sim.demo.picture.draw", lambda drive, path: None)


def run(*arguments: str) -> int:
    """Run the command in this process; return its exit code."""
    try:
        return program.main(arguments)
    except SystemExit as error:
        return int(error.code or 0)


def miss(_: list[Record], events: list[Record]) -> None:
    events.remove(named(events, "SONAR_DISABLED")[1])


def test_the_made_up_drive_has_the_demos_course_and_faults() -> None:
    assert program.parser().get_default("fail") == FAULTS
    scenario = program._scenario(program.parser().parse_args([*ROOM]))
    assert scenario.course == WAYPOINTS[1:]


def test_it_drives_through_the_office_unless_told_otherwise() -> None:
    scenario = program._scenario(program.parser().parse_args([]))
    assert scenario.world == "open-office"
    assert [fault.text.split("@")[0] for fault in scenario.faults] == ["off:3", "wrong:6"]


def test_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("--help") == 0
    out = capsys.readouterr().out
    for option in (
        "--seed",
        "--fail",
        "--policy",
        "--world",
        "--out",
        "--argusd",
        "--timeout",
        "--no-live",
        "--json",
    ):
        assert option in out, option
    assert "examples:" in out
    assert "exit codes:" in out


@pytest.mark.parametrize(
    "arguments",
    [
        ["--fail", ""],
        ["--fail", "off"],
        ["--fail", "off:0"],
        ["--fail", "off:7"],
        ["--fail", "off:16"],
        ["--fail", "stuck:3"],
        ["--fail", "off:3,"],
        ["--fail", "off:3,wrong:3"],
        ["--fail", "off:1,off:2,off:3"],
        ["--fail", "off:3;wrong:6"],
        ["--fail", "off:\u0663"],
        ["--seed", "-1"],
        ["--seed", "1.5"],
        ["--seed", "9223372036854775808"],
        ["--timeout", "0"],
        ["--timeout", "nan"],
        ["--timeout", "inf"],
        ["--timeout", "soon"],
        ["--policy", "best"],
        ["--world", "moon"],
        ["--wat"],
        ["stray"],
    ],
    ids=" ".join,
)
def test_bad_arguments_give_one_line_and_2(
    arguments: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str], played: type[Played]
) -> None:
    assert run("--out", str(tmp_path / "out"), *arguments) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1
    assert said.err.endswith("--help\n")
    assert not (tmp_path / "out").exists()


def test_a_folder_that_cannot_be_made_gives_one_line_and_2(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], played: type[Played]
) -> None:
    (tmp_path / "file").write_text("in the way", encoding="utf-8")
    assert run("--out", str(tmp_path / "file" / "out")) == 2
    said = capsys.readouterr()
    assert said.err.count("\n") == 1
    assert "--out" in said.err


def test_a_picture_that_cannot_be_written_gives_one_line_and_2(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], played: type[Played]
) -> None:
    (tmp_path / "demo.png").mkdir()
    assert run("--out", str(tmp_path)) == 2
    said = capsys.readouterr()
    assert said.err.count("\n") == 1
    assert "demo.png" in said.err


def test_a_good_drive_ends_with_0_and_leaves_its_files(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], played: type[Played]
) -> None:
    assert run(*ROOM, "--out", str(tmp_path)) == 0
    said = capsys.readouterr()
    assert said.err == ""
    assert "PASSED" in said.out
    assert str(tmp_path / "demo.png") in said.out
    assert (tmp_path / "demo.png").stat().st_size > 20_000
    assert json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))["passed"] is True
    assert "\033[" not in said.out


@pytest.mark.usefixtures("undrawn")
def test_a_bad_drive_ends_with_1(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], played: type[Played]
) -> None:
    played.doctor = staticmethod(miss)
    assert run(*ROOM, "--out", str(tmp_path)) == 1
    assert "FAILED: diagnosis equals injection" in capsys.readouterr().out
    assert json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))["passed"] is False


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize("bad", [False, True])
def test_json_is_one_object_and_nothing_else(
    bad: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str], played: type[Played]
) -> None:
    if bad:
        played.doctor = staticmethod(miss)
    assert run(*ROOM, "--json", "--out", str(tmp_path)) == int(bad)
    said = capsys.readouterr()
    assert said.out.count("\n") == 1
    record = json.loads(said.out)
    assert record["passed"] is not bad
    assert record["picture"] == str(tmp_path / "demo.png")
    assert record["ended"] == "goal reached"
    assert [one["fault"] for one in record["findings"]] == [
        {"kind": fault.kind, "sonar": fault.sonar} for fault in FAULTS
    ]
    assert {"name", "holds", "detail"} == set(record["rules"][0])
    assert said.err == ""


@pytest.mark.usefixtures("undrawn")
def test_argusd_is_told_neither_scenario_nor_seed_nor_faults(tmp_path: Path, played: type[Played]) -> None:
    run("--json", "--out", str(tmp_path), "--seed", "77", "--fail", "off:2,wrong:4", "--policy", "fewest")
    given = played.setup.course.read_text(encoding="utf-8") + played.setup.config.read_text(encoding="utf-8")
    assert given.split("\n")[-3:] == ["profile = argus", "policy = fewest", ""]
    for secret in ("77", "off", "wrong", "seed", "sonar"):
        assert secret not in given, secret
    scenario = yaml.safe_load((tmp_path / "scenario.yaml").read_text(encoding="utf-8"))
    assert scenario["seed"] == 77
    assert [text.split("@")[0] for text in scenario["faults"]] == ["off:2", "wrong:4"]


def test_one_fault_is_enough() -> None:
    assert program.parser().parse_args(["--fail", "wrong:5"]).fail == (Injected("wrong", 5),)


@pytest.mark.parametrize(
    ("raised", "code"),
    [(CannotStart("no such thing"), 3), (KeyboardInterrupt(), 130), (program._Ended(signal.SIGTERM), 143)],
    ids=["cannot start", "Ctrl-C", "SIGTERM"],
)
def test_a_drive_that_ends_before_its_time(
    raised: BaseException, code: int, tmp_path: Path, capsys: pytest.CaptureFixture[str], played: type[Played]
) -> None:
    played.raises = raised
    assert run("--json", "--out", str(tmp_path)) == code
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.count("\n") == 1


@pytest.mark.usefixtures("undrawn")
def test_signal_handlers_are_given_back(tmp_path: Path, played: type[Played]) -> None:
    before = [signal.getsignal(number) for number in ENDING]
    run("--json", "--out", str(tmp_path))
    assert [signal.getsignal(number) for number in ENDING] == before


# ---- real processes, none for longer than a start takes -----------------------------------------------------


def start(out: Path, *arguments: str, stdout: int = subprocess.PIPE) -> forks.Forked:
    return forks.start(
        "hil_sim.demo.cli:main",
        "--out",
        out,
        *arguments,
        cwd=ROOT,
        stdout=stdout,
        stderr=subprocess.PIPE,
    )


def users_of(folder: Path) -> list[int]:
    """Processes that have the folder in their command line: the demo's children have."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit() and int(entry.name) != os.getpid():
            try:
                if str(folder).encode() in (entry / "cmdline").read_bytes():
                    found.append(int(entry.name))
            except OSError:
                continue
    return found


def wait_for(what: Callable[[], bool], within_s: float = 600.0) -> None:
    until = time.monotonic() + within_s
    while not what():
        assert time.monotonic() < until, "nothing came of it"
        time.sleep(0.02)


@pytest.fixture
def idle_argusd(tmp_path: Path) -> Path:
    """A stand-in that opens no session and ends on SIGTERM as argusd does; it says one event so that output flows."""
    script = tmp_path / "stand-in"
    event = '{"t":0.0,"event":"MISSION_START","level":0,"name":"task","value":2}'
    script.write_text(
        f"#!/bin/sh\ntrap 'exit 0' TERM\nwhile :; do echo '{event}'; sleep 0.05; done\n", encoding="utf-8"
    )
    script.chmod(0o755)
    return script


def test_an_unknown_argusd_gives_one_line_and_3(tmp_path: Path) -> None:
    with start(tmp_path / "out", "--json", "--argusd", str(tmp_path / "none")) as demo:
        out, said = demo.communicate(timeout=600)
    assert demo.returncode == 3, said
    assert out == b""
    assert said.count(b"\n") == 1
    assert b"none" in said
    assert users_of(tmp_path) == []


def test_an_argusd_that_ends_at_once_gives_one_line_and_3(tmp_path: Path) -> None:
    with start(tmp_path / "out", "--json", "--argusd", "/bin/true") as demo:
        _, said = demo.communicate(timeout=600)
    assert demo.returncode == 3, said
    assert said.startswith(b"demo: argusd ended with code 0")
    assert users_of(tmp_path) == []


@pytest.mark.tour(1)
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP], ids=lambda one: one.name)
def test_a_signal_ends_both_programs(number: signal.Signals, tmp_path: Path, idle_argusd: Path) -> None:
    events = tmp_path / "out/events.jsonl"
    demo = start(tmp_path / "out", "--argusd", str(idle_argusd), stdout=subprocess.DEVNULL)
    try:
        wait_for(lambda: (events.exists() and events.stat().st_size > 0) or demo.poll() is not None)
        demo.send_signal(number)
        _, said = demo.communicate(timeout=600)
    finally:
        demo.kill()
        demo.wait()
    assert demo.returncode == 128 + number, said
    assert said.count(b"\n") == 1
    assert b"interrupted" in said
    wait_for(lambda: users_of(tmp_path) == [])


def test_a_reader_that_goes_away_leaves_nothing_behind(tmp_path: Path, idle_argusd: Path) -> None:
    demo = start(tmp_path / "out", "--argusd", str(idle_argusd))
    try:
        assert demo.stdout is not None
        assert demo.stderr is not None
        for _ in range(3):
            assert demo.stdout.readline()
        demo.stdout.close()
        assert demo.wait(600) == 128 + signal.SIGPIPE
        assert demo.stderr.read() == b""
        demo.stderr.close()
    finally:
        demo.kill()
        demo.wait()
    wait_for(lambda: users_of(tmp_path) == [])


@pytest.mark.usefixtures("undrawn")
@pytest.mark.parametrize(
    ("late_ms", "lasts", "drives", "code"),
    [(900.0, 1, 2, 0), (900.0, 9, program.TRIES, 1), (120.0, 9, 1, 1), (0.0, 9, 1, 1)],
    ids=["late-once", "late-always", "late-a-little", "punctual"],
)
def test_what_fails_while_the_host_is_late_is_driven_again(
    played: type[Played],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    late_ms: float,
    lasts: int,
    drives: int,
    code: int,
) -> None:
    driven = 0

    def doctor(truth: list[Record], events: list[Record]) -> None:
        nonlocal driven
        driven += 1
        if driven <= lasts:
            miss(truth, events)
            if late_ms:
                truth.insert(2, {"type": "late", "t_s": truth[1].get("t_s", 0.0), "late_ms": late_ms})

    played.doctor = staticmethod(doctor)
    assert run(*ROOM, "--no-live", "--out", str(tmp_path)) == code
    assert driven == drives
    told = capsys.readouterr().err
    assert told.count("so it is driven again") == drives - 1
    assert ("diagnosis equals injection" in told) == (drives > 1)
