# SPDX-License-Identifier: MIT
"""The stage of the ROS nodes: an environment of its own, with the packages of the extras [ros] and [foxglove]."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import tomllib
from pathlib import Path
from typing import Final

from devtool.base import BUILD, CORES, LOGS, ROOT, Run, quiet_ok, say, words
from devtool.cmake import build
from devtool.packaging import HERE, WORK, build_wheel
from devtool.setup import run_steps
from devtool.stages import making
from devtool.system import base_python

VENV_ROS: Final = BUILD / "venv-ros"
VENV_WHEEL: Final = BUILD / "venv-ros-wheel"
"""Its twin, in which the built wheel is installed in place of these sources."""
TESTERS: Final = ("pytest>=8.0", "pytest-xdist>=3.5", "hypothesis>=6.98", "setuptools>=68", "websockets>=13")
PYTEST: Final = ("pytest", "-q", "-p", "no:cacheprovider", "-n", str(CORES + 1), "--dist", "worksteal")
"""Each worker has a domain of its own; most wait for what their nodes hear."""
MAKER: Final = ROOT / "tools/argus_ros/make_messages.py"
NEEDS: Final = ("g++", "python-dev")


def recipe() -> tuple[str, str]:
    """Return digests of what the environment holds: packages, and the programs of this project."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    packages = (base_python(), VENV_ROS, project["dependencies"], extras["ros"], extras["foxglove"], TESTERS)
    found = hashlib.sha256(repr(packages).encode() + MAKER.read_bytes())
    return found.hexdigest(), hashlib.sha256(repr(project["scripts"]).encode()).hexdigest()


def lacking() -> str | None:
    """Make the environment unless it is there; return why it cannot be had, None when it can."""
    stamp, python = VENV_ROS / "argus-recipe", VENV_ROS / "bin/python"
    packages, programs = recipe()
    pip: list[str | Path] = [
        python,
        "-m",
        "pip",
        "install",
        "--no-input",
        "--no-compile",
        "--disable-pip-version-check",
    ]
    ourselves = [*pip, "--no-deps", "-e", ROOT]
    recorded = stamp.read_text().split() if stamp.exists() else []
    if recorded[:1] == [packages] and quiet_ok([python, "-c", "import rclpy, tf2_msgs"]):
        if recorded[1:] != [programs]:
            run_steps([ourselves], LOGS / "venv-ros.log")
            stamp.write_text(f"{packages} {programs}")
        return None
    say("making build/venv-ros (ROS from PyPI, about two minutes, once)")
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    log = LOGS / "venv-ros.log"
    run_steps([[base_python(), "-m", "venv", "--clear", VENV_ROS]], log)
    extras = project["optional-dependencies"]
    with log.open("a") as file:
        command = words([*pip, *extras["ros"], *extras["foxglove"]])
        had = subprocess.run(command, stdout=file, stderr=file, check=False)
    if had.returncode:
        return f"skipped: the packages of ROS cannot be had here, see {log.relative_to(ROOT)}"
    run_steps(
        [[*pip, *project["dependencies"], *TESTERS], ourselves, [python, MAKER]], LOGS / "venv-ros-more.log"
    )
    stamp.write_text(f"{packages} {programs}")
    return None


def install_wheel(run: Run) -> None:
    """Build the wheel, and install it with its extras in a twin of the environment, which has none of these sources."""
    wheel = build_wheel(HERE, run, WORK / f"wheel-ros-{HERE}")
    shutil.rmtree(VENV_WHEEL, ignore_errors=True)
    # Files of the twin are links to those of the other: it takes seconds and no room.
    shutil.copytree(VENV_ROS, VENV_WHEEL, symlinks=True, copy_function=os.link)
    python = VENV_WHEEL / "bin/python"
    pip: list[str | Path] = [python, "-m", "pip", "--disable-pip-version-check", "--no-input"]
    run([*pip, "uninstall", "-y", "-q", "argus-p3dx"])
    run([*pip, "install", "-q", "--no-index", "--no-compile", f"{wheel}[ros,foxglove]"])


def ros_tests(run: Run) -> str | None:
    """Run the tests of the nodes, of these sources and of the wheel, where the packages of ROS can be had."""
    build("release", run)
    with making():
        why = lacking()
        if why is None:
            install_wheel(run)
    if why is None:
        run([VENV_ROS / "bin/python", "-m", *PYTEST, "tests/ros"])
    return why
