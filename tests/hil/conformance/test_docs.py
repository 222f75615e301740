# SPDX-License-Identifier: MIT
"""Rule: each command of argus-conformance in docs/emulator.md passes against our emulator, as it stands there."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Final

import pytest

ROOT: Final = Path(__file__).resolve().parents[3]
PAGE: Final = ROOT / "docs" / "emulator.md"
COMMANDS: Final = [
    line.strip()
    for line in PAGE.read_text(encoding="utf-8").splitlines()
    if line.startswith("    argus-conformance ")
]
TCP, PORT = "localhost:8101", "/dev/ttyUSB0"


def test_the_page_has_its_commands() -> None:
    assert len(COMMANDS) == 3
    assert all((TCP in command) != (PORT in command) for command in COMMANDS)


@pytest.mark.long
@pytest.mark.parametrize("command", COMMANDS)
def test_a_robot_passes_as_shown(command: str, tmp_path: Path) -> None:
    place = ["--tcp", "127.0.0.1:0"] if TCP in command else []
    emulator = subprocess.Popen(
        [sys.executable, "-m", "hil_sim.cli", "--truth", str(tmp_path / "truth.jsonl"), *place],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        assert emulator.stdout is not None
        address = emulator.stdout.readline().strip()
        _, *words = command.replace(TCP, address).replace(PORT, address).split()
        done = subprocess.run(
            [sys.executable, "-m", "hil_sim.conformance.cli", *words],
            cwd=ROOT,
            capture_output=True,
            text=True,
            timeout=600,
            check=False,
        )
    finally:
        emulator.terminate()
        emulator.wait(600)
    assert done.returncode == 0, done.stdout + done.stderr
    told = done.stdout.splitlines()
    if "--json" in words:
        assert {json.loads(line)["verdict"] for line in told} <= {"pass", "not applicable"}
        assert len(told) > 40
    else:
        assert re.fullmatch(r"\d+ pass, 0 fail, \d+ not applicable", told[-1])
        assert sum(line.startswith("pass ") for line in told) > 10
