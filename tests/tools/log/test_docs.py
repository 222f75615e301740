# SPDX-License-Identifier: MIT
"""Each command in docs/logs.md runs as it stands there and makes the file that it names."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

from failing import drive
from logs import ROOT, decode, run

DOCS = (ROOT / "docs" / "logs.md").read_text()
COMMANDS = [
    line for block in re.findall(r"```sh\n(.*?)```", DOCS, re.DOTALL) for line in block.splitlines() if line
]


def test_the_commands_run_in_their_order(tmp_path: Path) -> None:
    (tmp_path / "capture.bin").write_bytes(drive())
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
        assert done.returncode == 0, f"{command}\n{done.stderr}"
        assert done.stdout or done.stderr or " -o " in command, command
        for name in re.findall(r"\S+\.(?:png|svg|mcap|pcapng|jsonl)\b", command):
            assert (tmp_path / name).stat().st_size > 1000, command


def test_the_drive_shows_what_the_text_says(tmp_path: Path) -> None:
    path = tmp_path / "capture.bin"
    path.write_bytes(drive())
    rows = decode(path)
    assert sum(not row["ok"] for row in rows) == 1
    told = run("faults", path, "--profile", "paper").stdout.decode()
    assert re.search(r"sonar/front/03 SONAR_DEAD", told)
    assert re.search(r"sonar/front/04 SONAR_SUSPECT", told)
    assert re.search(r"sonar/front/06 SONAR_SUSPECT", told)
    first = run("decode", path).stdout.decode().splitlines()[1]
    assert first in DOCS
