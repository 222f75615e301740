# SPDX-License-Identifier: MIT
"""Rule: an output that is full or closed gives one line and an exit code, no traceback; who prints nothing works."""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
from pathlib import Path
from typing import Final

import pytest

from hil_sim.record.truth import TruthRecord

ROOT: Final = Path(__file__).resolve().parents[2]
CAPTURE: Final = "tests/data/captures/m_p3dx.jsonl"
SIM: Final = ("hil_sim.cli",)
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


def run(words: tuple[str, ...], shell: str) -> subprocess.CompletedProcess[str]:
    """Run a program with its output as the shell puts it."""
    env = {**os.environ, "PYTHONPATH": f"{ROOT}{os.pathsep}{ROOT / 'tools'}"}
    command = ["sh", "-c", f'exec "$@" {shell}', "sh", sys.executable, "-m", *words]
    return subprocess.run(
        command, cwd=ROOT, env=env, capture_output=True, text=True, timeout=600, check=False
    )


@pytest.mark.parametrize("words", PRINTING, ids=lambda words: " ".join(words[:2]))
@pytest.mark.parametrize(
    ("shell", "why"), [(">/dev/full", "No space left on device"), (">&-", "closed"), (">&- <&-", "closed")]
)
def test_an_output_that_takes_nothing_is_told_in_one_line(
    words: tuple[str, ...], shell: str, why: str
) -> None:
    done = run(words, shell)
    assert done.returncode == 2, done.stderr
    (line,) = (line for line in done.stderr.splitlines() if "standard output" in line)
    assert why in line
    assert "Traceback" not in done.stderr
    assert "Exception ignored" not in done.stderr


@pytest.mark.parametrize("words", PRINTING, ids=lambda words: " ".join(words[:2]))
def test_a_reader_that_went_is_no_error(words: tuple[str, ...]) -> None:
    done = run(words, "| true")
    assert (done.returncode, done.stderr) == (0, "")


def test_who_prints_nothing_does_its_work_without_an_output(tmp_path: Path) -> None:
    made = tmp_path / "drive.rec"
    assert run((*LOG, "convert", CAPTURE, str(made)), ">&-").returncode == 0
    assert run((*LOG, "diff", CAPTURE, str(made)), "").returncode == 0


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
    done = run(("argus_tools.log.cli", "decode", "-"), "<&-")
    assert done.returncode == 2
    assert done.stderr == "argus-log: -: standard input is closed; give a log file, or pipe one in\n"
