# SPDX-License-Identifier: MIT
"""Each command in docs/ring.md runs as it stands there, in its order, and gives what the page shows."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from logs import ROOT

DOCS = (ROOT / "docs" / "ring.md").read_text()
COMMANDS = [
    line for block in re.findall(r"```sh\n(.*?)```", DOCS, re.DOTALL) for line in block.splitlines() if line
]


def test_the_commands_run_in_their_order(tmp_path: Path) -> None:
    for sample in re.findall(r"\(samples/(\w+\.\w+)\)", DOCS):
        shutil.copy(ROOT / "docs" / "samples" / sample, tmp_path)
    [ring] = re.findall(r"```toml\n(.*?)```", DOCS, re.DOTALL)
    poses = "".join(
        f'[[sonar.pose]]\nx_mm = 100\ny_mm = {y}\nheading_deg = {deg}\nrole = "ahead"\n'
        for y, deg in ((50, 20), (-50, -20))
    )
    (tmp_path / "mine.toml").write_text(ring + poses)  # the page shows one sonar of three
    folder = tmp_path / "bin"
    folder.mkdir()
    for name, module in (("argus-log", "-m argus_tools.log.cli"), ("python", "")):
        (folder / name).write_text(f'#!/bin/sh\nexec "{sys.executable}" {module} "$@"\n')
        (folder / name).chmod(0o755)
    path = f"{folder}{os.pathsep}{os.environ['PATH']}"
    environment = {**os.environ, "PATH": path, "PYTHONPATH": f"{ROOT}{os.pathsep}{ROOT / 'tools'}"}
    assert len(COMMANDS) > 5
    told = ""
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
        finds = command.startswith("argus-log faults") and " disabled as " in done.stdout
        assert done.returncode == int(finds), f"{command}\n{done.stdout}{done.stderr}"
        told += done.stderr + done.stdout
        for name in re.findall(r"\S+\.(?:png|svg|mcap|bag|toml)\b", command):
            assert (tmp_path / name).stat().st_size > 500, command
    shown = re.findall(r"\n```\n(argus-log: .*?)```", DOCS, re.DOTALL)
    assert any("sonar/front/05" in block for block in shown)
    for block in shown:
        assert block in told, f"docs/ring.md shows another result; it is now:\n{told[:3000]}"
