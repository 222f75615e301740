# SPDX-License-Identifier: MIT
"""Set-up before anything else is done: packages of the system, .venv, and the lock that lets one happen at a time."""

from __future__ import annotations

import contextlib
import fcntl
import hashlib
import os
import shutil
import signal
import subprocess
import sys
import tomllib
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import IO, Final

from devtool.base import BUILD, EXIT_SETUP, LOGS, ROOT, VENV, Command, Stop, line_of, quiet_ok, say, words
from devtool.system import BASIC_NEEDS, PRESET_NEEDS, base_python, ensure_system
from hil_sim.version import version

HEADER: Final = ROOT / "firmware/include/argus/argus.h"
LOCK: Final = ROOT / "requirements.lock"
VENV_PROBE: Final = (
    "import importlib.util, numpy, pip, sys; sys.exit(importlib.util.find_spec('hil_sim') is None)"
)


def python_identity() -> str:
    """Return what a virtual environment is bound to: its interpreter and its place."""
    return f"{base_python()} {sys.version} {VENV}".replace("\n", " ")


def python_content() -> str:
    """Return a digest of what is to be installed: the lock, and what pyproject.toml says about packages."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    parts = [project.get("project"), project.get("build-system"), project.get("tool", {}).get("scikit-build")]
    return hashlib.sha256(LOCK.read_bytes() + repr([*parts, version()]).encode()).hexdigest()


def install_steps(fresh: bool) -> list[Command]:
    """Return the commands that make .venv as requirements.lock says; a FRESH one is made first."""
    python = VENV / "bin/python"
    pip: list[str | Path] = [python, "-m", "pip", "install", "--disable-pip-version-check", "--no-input"]
    steps: list[Command] = [
        [*pip, "--require-hashes", "-r", LOCK],
        [*pip, "--no-deps", "--no-build-isolation", "-e", ROOT],
    ]
    return [[base_python(), "-m", "venv", VENV], *steps] if fresh else steps


def run_steps(steps: Sequence[Command], log: Path) -> None:
    """Run STEPS with their output in LOG; stop with the end of it when one fails."""
    LOGS.mkdir(parents=True, exist_ok=True)
    with log.open("w") as file:
        for step in steps:
            file.flush()
            done = subprocess.run(words(step), cwd=ROOT, stdout=file, stderr=subprocess.STDOUT, check=False)
            if done.returncode:
                tail = "\n  ".join(log.read_text().splitlines()[-5:])
                raise Stop(f"{line_of(step)} failed; the end of {log}:\n  {tail}", EXIT_SETUP)


def leave_venv() -> None:
    """Start again with the interpreter that .venv was made with: what may be removed and made anew cannot run us."""
    if Path(sys.prefix) == VENV:
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})  # until `begun` is there again
        os.execv(base_python(), [base_python(), *sys.orig_argv[1:]])


def ensure_python() -> None:
    """Make .venv as requirements.lock says, unless it is so already."""
    stamp = VENV / "argus-recipe"
    identity, content = python_identity(), python_content()
    recorded = stamp.read_text().split("\n") if stamp.exists() else []
    usable = recorded[:1] == [identity] and quiet_ok([VENV / "bin/python", "-P", "-c", VENV_PROBE])
    if usable and recorded[1:] == [content]:
        return
    if usable:
        say("updating .venv from requirements.lock")
    else:
        if VENV.exists():
            say("removing a .venv that is broken or was made for another Python or folder")
            shutil.rmtree(VENV)
        say("making .venv from requirements.lock (about half a minute, once)")
    stamp.unlink(missing_ok=True)
    run_steps(install_steps(not usable), LOGS / "python.log")
    stamp.write_text(f"{identity}\n{content}")


def holder_of(file: IO[str]) -> str:
    """Return the process that wrote into the lock that it holds it, empty when that is not there yet."""
    file.seek(0)
    number, _, command = file.read().strip().partition(" ")
    return f": process {number}, {command}" if number.isdigit() else ""


@contextlib.contextmanager
def alone() -> Iterator[None]:
    """Let one set-up or build happen at a time in this folder; one that waits says for what."""
    BUILD.mkdir(exist_ok=True)
    with (BUILD / ".dev-lock").open("a+") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            say(f"waiting for another tools/dev in this folder{holder_of(file)}")
            fcntl.flock(file, fcntl.LOCK_EX)
        file.truncate(0)
        file.write(f"{os.getpid()} {line_of(['tools/dev', *sys.argv[1:]])}\n")
        file.flush()
        try:
            yield
        finally:
            file.truncate(0)


def ensure(presets: Sequence[str] = (), needs: Sequence[str] = ()) -> None:
    """Do all set-up for building PRESETS, running Python, and for what NEEDS says."""
    of_presets = [need for preset in presets for need in PRESET_NEEDS.get(preset, ())]
    with alone():
        ensure_system([*BASIC_NEEDS, *needs, *of_presets])
        ensure_python()
