# SPDX-License-Identifier: MIT
"""The stage `peers`: the vendor's programs against ours, where their sources are given."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

from devtool.base import VENV, Run, Stop
from devtool.cmake import build

SOURCES: Final = ("ARIA_SOURCE", "MOBILESIM_SOURCE", "P2OS_SOURCE", "ROSARIA_SOURCE", "PLAYER_SOURCE")
"""Folders with the sources of AriaCoda, MobileSim, p2os, rosaria and Player; nothing of them is kept here."""
MARKS: Final = {
    "ARIA_SOURCE": ("src/ArRobot.cpp", "include/Aria/ArRobot.h", "include/ArRobot.h"),
    "MOBILESIM_SOURCE": ("MapLoader.cc",),
    "P2OS_SOURCE": ("p2os_driver/package.xml", "*/p2os_driver/package.xml"),
    "ROSARIA_SOURCE": ("RosAria.cpp", "*/RosAria.cpp"),
    "PLAYER_SOURCE": ("server/drivers", "libplayercore"),
}
"""By what each is known: one of these is in its folder."""
ROOT_VARIABLE: Final = "ROS1_ROOT"
"""The folder of the Debian in which p2os, rosaria and Player are built."""


def given() -> dict[str, Path]:
    """The sources that the environment names."""
    return {name: Path(os.environ[name]) for name in SOURCES if os.environ.get(name)}


def check(name: str, folder: Path) -> None:
    """Refuse a folder that holds no such sources, before anything of it is copied or built."""
    if not folder.is_dir():
        raise Stop(f"{name}={folder}: there is no such folder; clone the sources, and give their folder")
    if not any(next(folder.glob(mark), None) for mark in MARKS[name]):
        there = " or ".join(MARKS[name])
        raise Stop(f"{name}={folder}: these are other sources, as {there} is not there (docs/peers.md)")


def peers(run: Run) -> str | None:
    """Build and run the peers whose sources are given; tell of those that are not."""
    sources = given()
    missing = [name for name in (*SOURCES, ROOT_VARIABLE) if not os.environ.get(name)]
    note = f"skipped what needs {', '.join(f'{name}=FOLDER' for name in missing)} (docs/peers.md)"
    if not sources:
        return note
    for name, folder in sources.items():
        check(name, folder)
    build("release", run)
    words = [f"{name}={path}" for name, path in sources.items()]
    run([VENV / "bin/python", Path(__file__).parents[1] / "peers/runs.py", *words])
    return note if missing else None
