# SPDX-License-Identifier: MIT
"""Measures argus-monitor: how old a reading is, from its SIP in argusd, when the browser has painted it."""

from __future__ import annotations

import argparse
import statistics
import sys
import tempfile
import time
from pathlib import Path
from typing import Final

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "monitor"))
from page_browser import Browser, Keys, Monitor, missing

GOAL_MS: Final = 150.0


def drive(browser: Browser) -> None:
    """Keep the robot on its way, so that all of the picture moves: a turn wherever it stands."""
    if browser.known("state.mode") == "IDLE":
        browser.focus_stage()
        browser.keys(Keys.ARROW_LEFT)


def measure(seconds: float, folder: Path) -> list[float]:
    """Return the age of each painted reading, ms."""
    monitor = Monitor(["--sim", "--world", "open-office", "--port", "0"], folder)
    browser = Browser(folder / "profile")
    try:
        browser.open(monitor.url)
        browser.wait("it stands", lambda: browser.known("state.mode") == "IDLE")
        browser.js("argusMonitor.latencies.splice(0)")  # of a page that was still loading
        found: list[float] = []
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            drive(browser)
            time.sleep(1)
            found += browser.js("return argusMonitor.latencies.splice(0)")
        return found
    finally:
        browser.close()
        monitor.end()


def main() -> int:
    """Print the figures; 1 when a reading was painted later than it must be."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=20.0, help="how long (default 20)")
    seconds = parser.parse_args().seconds
    if missing():
        print(f"monitor: skipped, not installed: {missing()}")
        return 0
    with tempfile.TemporaryDirectory() as folder:
        found = measure(seconds, Path(folder))
    parts = statistics.quantiles(found, n=100)
    within = 100 * sum(age <= GOAL_MS for age in found) / len(found)
    print(f"monitor: {len(found)} readings painted in {seconds:.0f} s")
    print(f"SIP to screen: median {parts[49]:.0f} ms, 95 % {parts[94]:.0f} ms, most {max(found):.0f} ms")
    print(f"within {GOAL_MS:.0f} ms: {within:.1f} %")
    return int(within < 100)


if __name__ == "__main__":
    sys.exit(main())
