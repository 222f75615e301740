# SPDX-License-Identifier: MIT
"""Rule: every command of tools/dev explains itself and refuses wrong arguments with exit code 2."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
COMMANDS = ("demo", "test", "build", "format", "lint", "coverage", "size", "bench", "clean")


def dev(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, str(ROOT / "tools/dev"), *arguments]
    return subprocess.run(command, check=False, capture_output=True, text=True, timeout=60)


def test_help_names_every_command() -> None:
    done = dev("--help")
    assert done.returncode == 0
    assert "examples:" in done.stdout
    for command in COMMANDS:
        assert re.search(rf"^    {command} ", done.stdout, re.MULTILINE), command


@pytest.mark.parametrize("command", COMMANDS)
def test_help_of_each_command(command: str) -> None:
    done = dev(command, "--help")
    assert done.returncode == 0
    assert "examples:" in done.stdout
    assert f"  tools/dev {command}" in done.stdout
    assert "exit codes:" in done.stdout


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ([], "required"),
        (["nonsense"], "invalid choice"),
        (["build", "nonsense"], "there are: debug release"),
        (["test", "--only", "nonsense"], "there are: tables release"),
        (["test", "--nonsense"], "unrecognized arguments"),
    ],
)
def test_wrong_arguments(arguments: list[str], expected: str) -> None:
    done = dev(*arguments)
    assert done.returncode == 2
    assert expected in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("command", ["test", "lint", "format"])
def test_list_prints_the_stages_and_does_nothing(command: str) -> None:
    done = dev(command, "--list")
    assert done.returncode == 0
    assert len(done.stdout.splitlines()) >= 2
    assert "dev:" not in done.stdout
