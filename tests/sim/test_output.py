# SPDX-License-Identifier: MIT
"""Rule: an output that is full or closed gives one line and an exit code, no traceback; who prints nothing works."""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import forks
import pytest

from hil_sim.record.truth import TruthRecord

ROOT: Final = Path(__file__).resolve().parents[2]
CAPTURE: Final = "tests/data/captures/m_p3dx.jsonl"
SIM: Final = ("hil_sim.cli.main",)
LOG: Final = ("argus_tools.log.cli",)
CTL: Final = ("argus_tools.control.cli",)
LINE: Final = len(b'{"type":"state","t_s":0.0,"x_mm":1000}\n')
PRINTING: Final = (
    (*SIM, "--duration", "0.2"),
    (*SIM, "--list-worlds"),
    (*SIM, "--list-faults"),
    (*LOG, "decode", CAPTURE),
    (*LOG, "decode", "--json", CAPTURE),
    (*LOG, "stats", CAPTURE),
    (*LOG, "convert", CAPTURE, "-", "--to-format", "jsonl"),
    (*LOG, "--version"),
    (*CTL, "--version"),
)
UNFINISHED: Final = (
    ("hil_sim.conformance.cli", "--list"),
    ("hil_sim.demo.cli", "--help"),
    ("argus_tools.monitor.cli", "--version"),
    ("argus_tools.flash_check", "--version"),
    ("argus_tools.foxglove_bridge", "--layout"),
    ("argus_ros.cli", "argus-ros", "--help"),
    ("argus_ros.cli", "argus-range-guard", "--help"),
)
"""Of programs whose work is not done when nobody reads on: they end as a shell has it."""
DEV: Final = ("prove", "--list"), ("--help",), ("test", "--list")


def run(words: tuple[str, ...], stdout: int, stdin: int = subprocess.DEVNULL) -> tuple[int, str]:
    """Run a program; return its exit code and what it complains of."""
    with forks.start(
        f"{words[0]}:main", *words[1:], stdin=stdin, stdout=stdout, stderr=subprocess.PIPE, cwd=ROOT
    ) as program:
        _, said = program.communicate(timeout=600)
    return program.wait(), said.decode()


@pytest.fixture(params=["full", "closed", "closed like its input"])
def taking_nothing(request: pytest.FixtureRequest) -> Iterator[tuple[str, int, int]]:
    """An output that takes nothing: why, and the descriptors of output and input."""
    if request.param != "full":
        yield "closed", forks.CLOSED, forks.CLOSED if "input" in request.param else subprocess.DEVNULL
        return
    stdout = os.open("/dev/full", os.O_WRONLY)
    yield "No space left on device", stdout, subprocess.DEVNULL
    os.close(stdout)


def assert_told(code: int, said: str, why: str) -> None:
    assert code == 2, said
    (line,) = (line for line in said.splitlines() if "standard output" in line)
    assert why in line
    assert "Traceback" not in said
    assert "Exception ignored" not in said


@pytest.mark.parametrize("words", PRINTING + UNFINISHED, ids=lambda words: " ".join(words[:2]))
def test_an_output_that_takes_nothing_is_told_in_one_line(
    words: tuple[str, ...], taking_nothing: tuple[str, int, int]
) -> None:
    why, stdout, stdin = taking_nothing
    assert_told(*run(words, stdout, stdin), why)


@pytest.mark.parametrize(
    ("shell", "why"), [(">/dev/full", "No space left on device"), (">&-", "closed"), (">&- <&-", "closed")]
)
def test_and_so_of_an_interpreter_that_a_shell_starts(shell: str, why: str) -> None:
    command = ["sh", "-c", f'exec "$@" {shell}', "sh", sys.executable, "-m", "argus_tools.control.cli"]
    env = {**os.environ, "PYTHONPATH": f"{ROOT}{os.pathsep}{ROOT / 'tools'}"}
    done = subprocess.run(
        [*command, "--version"], cwd=ROOT, env=env, capture_output=True, text=True, timeout=600, check=False
    )
    assert_told(done.returncode, done.stderr, why)


@pytest.mark.parametrize("words", PRINTING, ids=lambda words: " ".join(words[:2]))
def test_a_reader_that_went_is_no_error(words: tuple[str, ...]) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    try:
        assert run(words, writer) == (0, "")
    finally:
        os.close(writer)


@pytest.mark.parametrize("words", UNFINISHED, ids=lambda words: " ".join(words[:2]))
def test_a_reader_that_went_before_the_work_was_done(words: tuple[str, ...]) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    try:
        assert run(words, writer) == (128 + signal.SIGPIPE, "")
    finally:
        os.close(writer)


@pytest.mark.parametrize("words", DEV, ids=lambda words: " ".join(words))
@pytest.mark.parametrize("full", [True, False])
def test_tools_dev_likewise(words: tuple[str, ...], full: bool) -> None:
    out = "/dev/full" if full else ">(:)"
    command = f"exec 3> {out}; sleep 0.3; exec tools/dev {' '.join(words)} >&3"
    done = subprocess.run(
        ["bash", "-c", command], cwd=ROOT, capture_output=True, text=True, timeout=600, check=False
    )
    if full:
        assert_told(done.returncode, done.stderr, "No space left on device")
    else:
        assert (done.returncode, done.stderr) == (128 + signal.SIGPIPE, "")


def test_who_prints_nothing_does_its_work_without_an_output(tmp_path: Path) -> None:
    made = tmp_path / "drive.rec"
    assert run((*LOG, "convert", CAPTURE, str(made)), forks.CLOSED)[0] == 0
    assert run((*LOG, "diff", CAPTURE, str(made)), subprocess.DEVNULL)[0] == 0


@pytest.mark.parametrize("room", [0, 1, 7, 38, 39, 200])
def test_a_full_disk_leaves_whole_lines_of_truth(room: int, tmp_path: Path) -> None:
    """The file may grow by so many bytes more; what does not fit is cut back to the last whole line."""
    path = tmp_path / "truth.jsonl"
    said: list[str] = []
    record = TruthRecord(path, {"seed": 1}, said.append)
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (path.stat().st_size + room, hard))
    try:
        for n in range(20):
            record("state", {"t_s": n / 10, "x_mm": 1000})
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    record.close()
    text = path.read_text()
    assert text.endswith("\n")
    assert [json.loads(line)["type"] for line in text.splitlines()[:1]] == ["meta"]
    assert len(text.splitlines()) == 1 + room // LINE
    assert len(said) == 1
    assert "the truth record ends here (File too large)" in said[0]


def test_a_closed_input_is_told_in_one_line() -> None:
    code, said = run((*LOG, "decode", "-"), subprocess.DEVNULL, forks.CLOSED)
    assert code == 2
    assert said == "argus-log: -: standard input is closed; give a log file, or pipe one in\n"
