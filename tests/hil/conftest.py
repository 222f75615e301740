# SPDX-License-Identifier: MIT
"""The bench as a fixture, a timeline when a test fails, a watch on the host, and long tests first."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from pathlib import Path

import pytest
from harness import ARGUSD, SIM, Bench
from lateness import watch_host


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "long: takes more than 30 s; started first")
    watch_host(config, "hil")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Interleave the long tests with short ones: xdist hands out the first items in pairs."""
    long = [item for item in items if item.get_closest_marker("long")]
    short = [item for item in items if not item.get_closest_marker("long")]
    head: list[pytest.Item] = []
    while long:
        head.append(long.pop(0))
        if short:
            head.append(short.pop(0))
    items[:] = head + short


@pytest.fixture
def bench(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Bench]:
    """An empty bench; all that a test starts on it is ended with the test."""
    for program in (ARGUSD, SIM):
        if not program.exists():
            pytest.fail(f"{program} is missing: run tools/dev build", pytrace=False)
    result = Bench(tmp_path, request.node.name)
    try:
        yield result
    finally:
        result.close()


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.CallInfo[None], None]:
    """Show the timeline of a test that failed."""
    outcome = yield
    report = outcome.get_result()  # type: ignore[attr-defined]
    bench = getattr(item, "funcargs", {}).get("bench")
    if report.when == "call" and report.failed and isinstance(bench, Bench):
        report.sections.append(("timeline", bench.dump()))
