# SPDX-License-Identifier: MIT
"""What all parts of tools/dev share: where things are, how a line is told, how a child is started."""

from __future__ import annotations

import argparse
import os
import shlex
import shutil
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final, NoReturn

ROOT: Final = Path(__file__).resolve().parents[2]
BUILD: Final = ROOT / "build"
LOGS: Final = BUILD / "logs"
VENV: Final = ROOT / ".venv"
CORES: Final = os.cpu_count() or 1

EXIT_FAILED, EXIT_USAGE, EXIT_SETUP = 1, 2, 3
EXIT_SIGNAL: Final = 128

Command = Sequence[str | Path]
Run = Callable[[Command], None]
Action = Callable[[argparse.Namespace], int]
Add = Callable[[str, Action, str, str], argparse.ArgumentParser]
"""Adds a command: its name, what it does, what it is for, examples."""


class Stop(Exception):
    """Ends the program with one line of explanation and an exit code."""

    def __init__(self, message: str, code: int = EXIT_FAILED) -> None:
        super().__init__(message)
        self.code = code


def leave_at_sigterm() -> None:
    """Let SIGTERM end this program as an exception does, so that what it has started ends before it."""

    def leave(number: int, _frame: object) -> NoReturn:
        # A second one must not break off what the first has begun.
        signal.signal(number, signal.SIG_IGN)
        raise SystemExit(EXIT_SIGNAL + number)

    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, leave)


def paint(text: str, code: str) -> str:
    """Colour TEXT when stdout is a terminal that wants colour."""
    wanted = sys.stdout.isatty() and "NO_COLOR" not in os.environ and os.environ.get("TERM") != "dumb"
    return f"\033[{code}m{text}\033[0m" if wanted else text


def say(text: str) -> None:
    """Tell in one line what is being done."""
    print(f"dev: {text}", flush=True)


def words(command: Command) -> list[str]:
    """Return COMMAND as strings."""
    return [str(part) for part in command]


def line_of(command: Command) -> str:
    """Return COMMAND as one line of shell."""
    return shlex.join(words(command))


def shown(path: Path) -> str:
    """Return PATH from the project folder, where it lies below it."""
    return str(path.relative_to(ROOT) if path.is_relative_to(ROOT) else path)


def run_visibly(command: Command) -> None:
    """Run COMMAND in the project folder; its output goes to the terminal."""
    done = subprocess.run(words(command), cwd=ROOT, env=environment(), check=False)
    if done.returncode:
        raise Stop(f"failed with exit code {done.returncode}: {line_of(command)}")


def quiet_ok(command: Command) -> bool:
    """Tell whether COMMAND exists and succeeds."""
    try:
        done = subprocess.run(
            words(command),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            check=False,
        )
    except OSError:
        return False
    return done.returncode == 0


def environment() -> dict[str, str]:
    """Return the environment of every child: .venv first in PATH, Ninja when it is there."""
    env = dict(os.environ)
    env["PATH"] = f"{VENV / 'bin'}{os.pathsep}{env.get('PATH', '')}"
    env.pop("PYTHONHOME", None)
    # Where this is set each start of Python compiles what it imports. What it asks for is kept: none beside sources.
    if env.pop("PYTHONDONTWRITEBYTECODE", "") and "PYTHONPYCACHEPREFIX" not in env:
        env["PYTHONPYCACHEPREFIX"] = str(BUILD / "pycache")
    if "CMAKE_GENERATOR" not in env and shutil.which("ninja"):
        env["CMAKE_GENERATOR"] = "Ninja"
    env.setdefault("PIP_DISABLE_PIP_VERSION_CHECK", "1")
    return env
