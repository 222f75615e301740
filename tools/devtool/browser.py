# SPDX-License-Identifier: MIT
"""The stage of the page of argus-monitor, in a browser that is installed where that can be done."""

from __future__ import annotations

import shutil
from typing import Final

from devtool.base import VENV, Run, Stop
from devtool.cmake import build
from devtool.setup import alone
from devtool.stages import making
from devtool.system import apt_install

PROGRAMS: Final = ("chromium", "chromedriver")
PACKAGES: Final = ("chromium", "chromium-driver")
SIDE_BY_SIDE: Final = ("-n", "2", "--dist", "loadfile")


def lacking() -> str | None:
    """Install the browser unless it is there; return why it cannot be had, None when it can."""
    if all(shutil.which(name) for name in PROGRAMS):
        return None
    try:
        with alone():
            apt_install(PACKAGES)
    except Stop as error:
        return f"skipped: Chromium cannot be had here ({str(error).splitlines()[0]})"
    return None


def monitor_tests(run: Run) -> str | None:
    """Run the tests in the browser: those of a file in their order, with a browser and a robot of their own."""
    build("release", run)
    with making():
        why = lacking()
    if why is None:
        run([VENV / "bin/python", "-m", "pytest", "-q", *SIDE_BY_SIDE, "tests/monitor"])
    return why
