# SPDX-License-Identifier: MIT
"""Rule: the subject of a commit has at most 72 characters and no full stop at its end."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = [sys.executable, str(ROOT / "tools/commits.py")]


@pytest.mark.parametrize(
    ("subject", "code"),
    [
        ("Looks: a sonar at the end of an array is asked about last", 0),
        ("x" * 72, 0),
        ("x" * 73, 1),
        ("It stops.", 1),
        ("", 1),
    ],
)
def test_one_message(tmp_path: Path, subject: str, code: int) -> None:
    message = tmp_path / "message"
    message.write_text(subject + "\n\nA body may be as long as it likes to be.\n")
    done = subprocess.run([*PROGRAM, "--message", str(message)], capture_output=True, text=True, check=False)
    assert done.returncode == code, done.stdout


def test_a_message_that_is_not_there() -> None:
    done = subprocess.run([*PROGRAM, "--message", "/nowhere"], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "/nowhere" in done.stderr
