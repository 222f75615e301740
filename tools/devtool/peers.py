# SPDX-License-Identifier: MIT
"""The stage `peers`: the vendor's programs against ours, where their sources are given."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Final

from devtool.base import Run
from devtool.cmake import build

SOURCES: Final = ("ARIA_SOURCE", "MOBILESIM_SOURCE")
"""Folders with the sources of AriaCoda and of MobileSim; nothing of them is kept in this repository."""


def given() -> dict[str, Path]:
    """The sources that the environment names."""
    return {name: Path(os.environ[name]) for name in SOURCES if os.environ.get(name)}


def peers(run: Run) -> str | None:
    """Build and run the peers whose sources are given; tell of those that are not."""
    sources = given()
    missing = [name for name in SOURCES if name not in sources]
    note = f"skipped what needs {' and '.join(f'{name}=FOLDER' for name in missing)} (docs/peers.md)"
    if not sources:
        return note
    build("release", run)
    words = [f"{name}={path}" for name, path in sources.items()]
    run([sys.executable, Path(__file__).with_name("peer_runs.py"), *words])
    return note if missing else None
