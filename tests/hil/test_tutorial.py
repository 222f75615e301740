# SPDX-License-Identifier: MIT
"""Rule: each command of docs/tutorial.md runs as it stands there, and shows what the text says."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TEXT = (ROOT / "docs/tutorial.md").read_text(encoding="utf-8")
COMMANDS = [
    line for block in re.findall(r"```sh\n(.*?)```", TEXT, re.DOTALL) for line in block.splitlines() if line
]
FAULTS = "argus-log faults two-failing-sonars.rec.gz"
PROGRAM = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)
LIMIT_S = 600.0


@pytest.fixture(scope="module")
def told(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """Return the folder of a reader who has typed every command into one shell, and what came out."""
    folder = tmp_path_factory.mktemp("tutorial")
    shutil.copy(ROOT / "docs/samples/two-failing-sonars.rec.gz", folder)
    (folder / "drives.py").write_text("".join(PROGRAM), encoding="utf-8")
    script = "set -e\nset -m\n"
    for number, command in enumerate(COMMANDS):
        may_fail = " || [ $? = 124 ]" if command.startswith("timeout") else ""
        may_fail = " || [ $? = 1 ]" if command.startswith("argus-log faults") else may_fail
        script += f"echo '=== {number}'\n{command}{may_fail}\n"
    path = os.pathsep.join([str(ROOT / ".venv/bin"), str(ROOT / "build/release"), os.environ["PATH"]])
    python_path = os.pathsep.join([str(ROOT), str(ROOT / "tools")])
    done = subprocess.run(
        ["bash", "-c", script],
        cwd=folder,
        env={**os.environ, "PATH": path, "PYTHONPATH": python_path},
        capture_output=True,
        text=True,
        timeout=LIMIT_S,
        check=False,
    )
    assert done.returncode == 0, f"{done.stdout[-3000:]}\n{done.stderr[-3000:]}"
    return folder, done.stdout


def test_the_commands_are_those_of_the_text() -> None:
    assert len(COMMANDS) >= 9
    assert len(PROGRAM) == 1


def without_times(text: str) -> str:
    """Return a text in which times do not count."""
    return re.sub(r"\d+(?:\.\d+)? s\b", "T s", text)


@pytest.mark.long
def test_the_log_tells_what_the_text_shows(told: tuple[Path, str]) -> None:
    found = re.search(rf"```sh\n{re.escape(FAULTS)}\n```\n\n```\n(.*?)```", TEXT, re.DOTALL)
    assert found is not None, "the output stands in a block of its own behind the command"
    said = re.split(r"^=== \d+\n", told[1], flags=re.MULTILINE)[1 + COMMANDS.index(FAULTS)]
    assert without_times(said) == without_times(found[1])
    assert (told[0] / "ring.png").stat().st_size > 10_000


@pytest.mark.long
def test_the_robot_answers_and_finds_its_dead_sonar(told: tuple[Path, str]) -> None:
    assert "p3dx-sh" in told[1]
    events = (told[0] / "drive.jsonl").read_text(encoding="utf-8")
    for event in ("SONAR_SUSPECT", "SONAR_NAMED", "SONAR_DISABLED"):
        assert re.search(rf'"event":"{event}".*"name":"sonar/front/03"', events), event
    assert '"event":"GOAL_REACHED"' in events


@pytest.mark.long
def test_every_drive_in_one_process_arrives(told: tuple[Path, str]) -> None:
    drives = re.findall(r"^(\d) reached: (\w+) hit: (\d+) sonar 3: (.*)$", told[1], re.MULTILINE)
    assert [drive[:3] for drive in drives] == [(str(seed), "True", "0") for seed in range(1, 6)]
