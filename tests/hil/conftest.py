# SPDX-License-Identifier: MIT
"""The bench as a fixture, a timeline when a test fails, a watch on the host, and long tests first."""

from __future__ import annotations

from collections.abc import Generator, Iterator
from pathlib import Path

import pytest
from harness import ARGUSD, SIM, Bench, HilFailure
from lateness import watch_host
from pluggy import Result
from watch import breaches


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "long: takes more than 30 s; started first")
    config.addinivalue_line("markers", "monitored: what its drives break of S1 to S8 fails it, too")
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
    records = request.node.get_closest_marker("monitored") is not None
    result = Bench(tmp_path, request.node.name, records=records)
    try:
        yield result
    finally:
        result.close()


@pytest.hookimpl(hookwrapper=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> Generator[None, Result[None], None]:
    """Let the safety monitor watch what was driven, where nothing else failed."""
    outcome = yield
    bench = pyfuncitem.funcargs.get("bench")
    if outcome.exception is None and pyfuncitem.get_closest_marker("monitored") and isinstance(bench, Bench):
        bench.close()
        if found := breaches(bench):
            outcome.force_exception(HilFailure("\n".join(found)))


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: pytest.Item) -> Generator[None, pytest.CallInfo[None], None]:
    """Show the timeline of a test that failed."""
    outcome = yield
    report = outcome.get_result()  # type: ignore[attr-defined]
    bench = getattr(item, "funcargs", {}).get("bench")
    if report.when == "call" and report.failed and isinstance(bench, Bench):
        report.sections.append(("timeline", bench.dump()))
