# SPDX-License-Identifier: MIT
"""Each command in docs/emulator.md and docs/worlds.md runs as it stands there."""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import forks
import pytest

DOCS: Final = Path(__file__).resolve().parents[2] / "docs"
MODULES: Final = {
    "argus-sim": "hil_sim.cli.main:main",
    "argus-conformance": "hil_sim.conformance.cli:main",
}
COMMANDS: Final = [
    line.strip()
    for page in ("emulator.md", "worlds.md")
    for line in (DOCS / page).read_text(encoding="utf-8").splitlines()
    if re.match(r" {4}argus-(sim|conformance) ", line)
]
LONG: Final = re.compile(" bench |^argus-conformance")
PORT: Final = "/dev/ttyUSB0"


def run(command: str, folder: Path) -> subprocess.CompletedProcess[bytes]:
    program, *words = command.split()
    return forks.run(MODULES[program], *words, cwd=folder)


@pytest.fixture
def robot(tmp_path: Path) -> Iterator[str]:
    """A robot at the port that the pages name."""
    with forks.start(
        MODULES["argus-sim"], "--link-name", tmp_path / "robot", cwd=tmp_path, stdout=subprocess.PIPE
    ) as emulator:
        assert emulator.stdout is not None
        emulator.stdout.readline()
        yield str(tmp_path / "robot")
        emulator.terminate()
        assert emulator.wait(60) == 0


def test_the_pages_have_their_commands() -> None:
    assert len(COMMANDS) == 8
    assert sum(bool(LONG.search(command)) for command in COMMANDS) == 4


@pytest.mark.parametrize("command", [command for command in COMMANDS if not LONG.search(command)])
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


@pytest.mark.soak
@pytest.mark.parametrize("command", [command for command in COMMANDS if command.startswith("argus-conf")])
def test_a_robot_is_checked_as_shown(command: str, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    if "tcp:localhost:8101" in command:
        with forks.start(
            MODULES["argus-sim"], "--tcp", "127.0.0.1:0", cwd=tmp_path, stdout=subprocess.PIPE
        ) as emulator:
            assert emulator.stdout is not None
            address = emulator.stdout.readline().decode().strip()
            done = run(command.replace("localhost:8101", address), tmp_path)
            emulator.terminate()
    else:
        assert PORT in command
        done = run(command.replace(PORT, request.getfixturevalue("robot")), tmp_path)
    # Whether all pass is the rule of tests/hil/conformance, on a host that is in time.
    assert done.returncode in (0, 1), done.stderr.decode()
    told = done.stdout.decode().splitlines()
    if "--json" in command:
        assert {json.loads(line)["verdict"] for line in told} <= {"pass", "fail", "not applicable"}
        assert len(told) > 40
    else:
        assert re.fullmatch(r"\d+ pass, \d+ fail, \d+ not applicable", told[-1])
        assert sum(line.startswith("pass ") for line in told) > 10
