# SPDX-License-Identifier: MIT
"""How the tests of the packages run commands."""

from __future__ import annotations

import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DIST = ROOT / "dist"


def run(*command: str | Path, **options: object) -> str:
    """Run a command that must succeed; return what it prints."""
    words = [str(word) for word in command]
    settings: dict[str, object] = {
        "cwd": ROOT,
        "capture_output": True,
        "text": True,
        "timeout": 900,
    } | options
    done = subprocess.run(words, check=False, **settings)  # type: ignore[call-overload]
    assert done.returncode == 0, f"{words}:\n{done.stdout}{done.stderr}"
    return str(done.stdout)
