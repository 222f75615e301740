#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Draw docs/img/monitor.png: the live page in a real browser while the robot covers for a dead sonar."""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tests/monitor"))

import argus  # noqa: E402
from page_browser import Browser, Monitor, missing  # noqa: E402
from PIL import Image  # noqa: E402

PICTURE = ROOT / "docs/img/monitor.png"
COLOURS = 128  # a third of the bytes, and nothing to be seen of it
WIDE = (1280, 860)
PHONE = (360, 740)
DEAD = 3
GOAL_MM = (3000, 0)
WAY_MM = 1200
FOUND_S = 180.0


def drive(page: Browser, control: Path) -> None:
    """Drive off, and wait until the fault has its name and the robot is on its way."""
    with argus.connect(f"unix:{control}") as robot:
        robot.order("goto", x_mm=GOAL_MM[0], y_mm=GOAL_MM[1])
        page.wait(
            "the dead sonar is named",
            lambda: (page.known("state.kind") or {DEAD: ""})[DEAD] == "silent",
            FOUND_S,
        )
        page.wait("it is under way", lambda: page.known("state.x_mm") > WAY_MM, FOUND_S)


def main() -> int:
    """Write the picture, or with --all one of each size and colour into a folder."""
    parser = argparse.ArgumentParser(
        description=__doc__, epilog="example: tools/gen_page_picture.py; takes a build (tools/dev build)"
    )
    parser.add_argument("--all", type=Path, metavar="FOLDER", help="wide and as a phone, light and dark")
    folder: Path | None = parser.parse_args().all
    if missing():
        parser.error(f"not installed: {missing()}")
    with tempfile.TemporaryDirectory() as scratch:
        monitor = Monitor(
            ["--sim", "--world", "office", "--fault", f"silent:{DEAD}@12s", "--port", "0"], Path(scratch)
        )
        browser = Browser(Path(scratch) / "profile")
        try:
            browser.open(monitor.url)
            drive(browser, monitor.control)
            if folder is None:
                browser.driver.save_screenshot(str(PICTURE))
                Image.open(PICTURE).convert("RGB").quantize(COLOURS).save(PICTURE, optimize=True)
                return 0
            folder.mkdir(parents=True, exist_ok=True)
            for name, size in (("wide", WIDE), ("phone", PHONE)):
                for dark in (False, True):
                    browser.size(*size)
                    browser.dark(dark)
                    time.sleep(1.0)
                    browser.driver.save_screenshot(str(folder / f"{name}-{'dark' if dark else 'light'}.png"))
        finally:
            browser.close()
            monitor.end()
    return 0


if __name__ == "__main__":
    sys.exit(main())
