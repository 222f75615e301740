# SPDX-License-Identifier: MIT
"""Fixtures of the tests on a real CAN bus, which tools/with-can provides."""

from __future__ import annotations

import socket
from collections.abc import Generator, Iterator
from pathlib import Path

import pytest
from harness import ARGUSD, SIM, Bench
from lateness import watch_host


def pytest_configure(config: pytest.Config) -> None:
    watch_host(config, "can")


def pytest_sessionstart(session: pytest.Session) -> None:
    """Without a bus nothing here can be tested, and that is a failure, not a skip."""
    names = {name for _, name in socket.if_nameindex()}
    if not {"vcan0", "vcan1"} <= names:
        pytest.exit("no vcan0 and vcan1 here; run: tools/dev test --only can", returncode=3)
    for program in (ARGUSD, SIM):
        if not program.exists():
            pytest.exit(f"{program} is missing: run tools/dev build", returncode=3)


@pytest.fixture
def bench(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Bench]:
    """An empty bench; all that a test starts on it is ended with the test."""
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
