# SPDX-License-Identifier: MIT
"""Each command in docs/logs.md runs as it stands there and makes the file that it names."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from argus_tools.formats import formats
from logs import ROOT, decode, run
from matplotlib.image import imread

DOCS = (ROOT / "docs" / "logs.md").read_text()
SAMPLE = ROOT / "docs" / "samples" / "two-failing-sonars.rec.gz"
SAMPLE_MAX_BYTES = 200_000
COMMANDS = [
    line for block in re.findall(r"```sh\n(.*?)```", DOCS, re.DOTALL) for line in block.splitlines() if line
]


@pytest.mark.soak
def test_the_commands_run_in_their_order(tmp_path: Path) -> None:
    shutil.copy(SAMPLE, tmp_path)
    program = tmp_path / "bin" / "argus-log"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m argus_tools.log.cli "$@"\n')
    program.chmod(0o755)
    path = f"{program.parent}{os.pathsep}{os.environ['PATH']}"
    environment = {**os.environ, "PATH": path, "PYTHONPATH": f"{ROOT}{os.pathsep}{ROOT / 'tools'}"}
    assert len(COMMANDS) > 12
    for command in COMMANDS:
        done = subprocess.run(
            command,
            shell=True,
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
            timeout=600,
            check=False,
        )
        found = command.startswith("argus-log faults")
        assert done.returncode == (1 if found else 0), f"{command}\n{done.stderr}"
        assert done.stdout or done.stderr or " -o " in command, command
        for name in re.findall(r"\S+\.(?:png|svg|mcap|pcapng|jsonl)\b", command):
            assert (tmp_path / name).stat().st_size > 1000, command


def test_the_drive_shows_what_the_text_says() -> None:
    told = run("faults", SAMPLE).stdout.decode()
    found = re.findall(r"^sonar/front/(\d\d) (?:disabled as|suspect .*perhaps) (\w+)", told, re.MULTILINE)
    assert found == [("03", "off"), ("06", "wrong")]
    assert f"```\n{told}```" in DOCS, f"docs/logs.md shows another result; it is now:\n{told}"
    assert any(line in DOCS for line in run("decode", SAMPLE).stdout.decode().splitlines()[1:])
    assert re.search(r"^ *3 +\d+ .* 64\.\d%", run("stats", SAMPLE).stdout.decode(), re.MULTILINE)


@pytest.mark.parametrize(
    ("picture", "arguments"),
    [("logs-sonars.png", ("--sonar", "0-7")), ("ring.png", ("--view", "ring", "--at", "+60"))],
)
def test_the_pictures_are_what_the_fault_manager_says_now(
    picture: str, arguments: tuple[str, ...], tmp_path: Path
) -> None:
    done = run("plot", SAMPLE, "-o", tmp_path / picture, *arguments)
    assert done.returncode == 0, done.stderr.decode()
    shown, made = imread(ROOT / "docs/img" / picture), imread(tmp_path / picture)
    assert shown.shape == made.shape
    # Another release of the library that draws may smooth an edge otherwise; a suspect that is none is a whole area.
    assert float((abs(shown - made).max(axis=2) > 0.1).mean()) < 0.002


def test_the_sample_is_a_whole_session_and_small() -> None:
    assert SAMPLE.stat().st_size < SAMPLE_MAX_BYTES
    rows = decode(SAMPLE)
    assert {row["dir"] for row in rows} == {"r2c", "c2r"}
    assert sum(row["type"] == "SIP" for row in rows) > 1000


def test_every_format_has_its_row() -> None:
    table = DOCS[DOCS.index("| name |") :]
    first = " ".join(line.split("|")[1] for line in table.splitlines() if line.startswith("| `"))
    assert set(re.findall(r"`([\w-]+)`", first)) == set(formats())
