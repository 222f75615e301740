# SPDX-License-Identifier: MIT
"""Each command of argus-sim in docs/emulator.md and docs/worlds.md runs as it stands there."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path
from typing import Final

import forks
import pytest

DOCS: Final = Path(__file__).resolve().parents[2] / "docs"
ARGUS_SIM: Final = "hil_sim.cli.main:main"
COMMANDS: Final = [
    line.strip()
    for page in ("emulator.md", "worlds.md")
    for line in (DOCS / page).read_text(encoding="utf-8").splitlines()
    if line.startswith("    argus-sim ")
]


def run(command: str, folder: Path) -> subprocess.CompletedProcess[bytes]:
    return forks.run(ARGUS_SIM, *command.split()[1:], cwd=folder)


def test_the_pages_have_their_commands() -> None:
    assert len(COMMANDS) == 5
    assert sum(" bench " in command for command in COMMANDS) == 1


@pytest.mark.parametrize("command", [command for command in COMMANDS if " bench " not in command])
def test_an_emulator_starts_as_shown(command: str, tmp_path: Path) -> None:
    done = run(f"{command} --duration 0.3", tmp_path)
    assert (done.returncode, done.stdout.startswith(b"/dev/pts/")) == (0, True), done.stderr


@pytest.mark.soak
@pytest.mark.parametrize("command", [command for command in COMMANDS if " bench " in command])
def test_a_bench_runs_as_shown(command: str, tmp_path: Path) -> None:
    done = run(command, tmp_path)
    assert done.returncode == 0, done.stderr
    out = re.search(r"--out (\S+)", command)
    assert out
    assert any((tmp_path / out[1]).iterdir())
