# SPDX-License-Identifier: MIT
"""The site of the documents: Sphinx from docs/requirements.lock, installed into .venv when it is asked for."""

from __future__ import annotations

import argparse
import hashlib
import subprocess
from typing import Final

from devtool.base import (
    BUILD,
    EXIT_SETUP,
    LOGS,
    ROOT,
    VENV,
    Add,
    Command,
    Run,
    Stop,
    quiet_ok,
    say,
    shown,
    words,
)
from devtool.browser import lacking as browser_lacking
from devtool.commands import quietly
from devtool.setup import alone, ensure
from devtool.stages import making

LOCK: Final = ROOT / "docs/requirements.lock"
STAMP: Final = VENV / "argus-docs"
SITE: Final = BUILD / "site"
BUILDER: Final[Command] = (
    *(VENV / "bin/python", "-m", "sphinx", "-q", "-W", "--keep-going", "-c", ROOT / "docs"),
    *(ROOT, SITE),
)


def lacking() -> str | None:
    """Install the generator unless it is there; return why it cannot be had, None when it can."""
    python = VENV / "bin/python"
    content = hashlib.sha256(LOCK.read_bytes()).hexdigest()
    there = STAMP.exists() and STAMP.read_text() == content
    if there and quiet_ok([python, "-c", "import furo, myst_parser, pandas, sphinx"]):
        return None
    say("installing the site's generator into .venv (docs/requirements.lock, 160 MB, once)")
    pip: Command = [python, "-m", "pip", "install", "--no-input", "--disable-pip-version-check"]
    LOGS.mkdir(parents=True, exist_ok=True)
    log = LOGS / "docs-packages.log"
    with log.open("w") as file:
        command = words([*pip, "--require-hashes", "-r", LOCK])
        done = subprocess.run(command, stdout=file, stderr=file, check=False)
    if done.returncode:
        return f"the packages of docs/requirements.lock cannot be had here, see {shown(log)}"
    STAMP.write_text(content)
    return None


def make_site(run: Run) -> None:
    """Build the site; a link that leads nowhere is an error."""
    with alone():
        run(BUILDER)


def site_tests(run: Run) -> str | None:
    """Build the site and test it, its pages in a browser where one can be had."""
    with making():
        why = lacking()
        if why is not None:
            return f"skipped: {why}"
        make_site(run)
        why = browser_lacking()
    run([VENV / "bin/python", "-m", "pytest", "-q", "tests/docs"])
    return why


def do_docs(_args: argparse.Namespace) -> int:
    """Make the site."""
    ensure()
    why = lacking()
    if why is not None:
        raise Stop(why, EXIT_SETUP)
    quietly("building the site", make_site)
    say(f"the documents: {shown(SITE / 'index.html')}")
    return 0


def add_commands(add: Add) -> None:
    """Add the command that makes the site."""
    add("docs", do_docs, "make the site of the documents, build/site/index.html; a dead link fails", "docs")
