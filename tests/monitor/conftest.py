# SPDX-License-Identifier: MIT
"""One emulated robot with its page, and one browser, for all tests of the page."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from page_browser import ROOT, Browser, Monitor, missing


@pytest.fixture(scope="session")
def _able() -> None:
    if missing():
        pytest.skip(f"not installed: {missing()}")
    if not (ROOT / "build/release/argusd").exists():
        pytest.fail("build/release/argusd is missing: run tools/dev build release", pytrace=False)


@pytest.fixture(scope="session")
def monitor(_able: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Monitor]:
    """argus-monitor --sim in an open hall, which has all kinds of room to drive."""
    made = Monitor(["--sim", "--world", "open-office", "--port", "0"], tmp_path_factory.mktemp("monitor"))
    yield made
    made.end()


@pytest.fixture(scope="session")
def chromium(_able: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    """A browser with an empty profile."""
    made = Browser(tmp_path_factory.mktemp("profile"))
    yield made
    made.close()


@pytest.fixture
def page(monitor: Monitor, chromium: Browser) -> Iterator[Browser]:
    """The page, opened anew, wide and light, in control of nothing; all sonars are mended afterwards."""
    chromium.size(1280, 860)
    chromium.open(monitor.url)
    chromium.complaints()
    yield chromium
    for sonar in chromium.known("broken") or {}:
        chromium.js(f"argusMonitor.mend({sonar})")
    chromium.js("argusMonitor.stop()")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder of the test's own."""
    return tmp_path
