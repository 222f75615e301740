# SPDX-License-Identifier: MIT
"""Tells which tests failed while the host was late, so that tools/dev may run exactly those again."""

from __future__ import annotations

import json
import threading
import time
from collections.abc import Generator
from pathlib import Path
from typing import Final

import pytest
from harness import ROOT

from hil_sim.links.loop import LATE_MS

_TICK_S: Final = 0.02
_KEY: Final = "host_late_ms"
_LATE_RECORD: Final = '{"type":"late",'


class Metronome:
    """A thread that wants to wake every 20 ms, and how late it was at worst since it was last reset."""

    def __init__(self) -> None:
        self.worst_ms = 0.0
        self._due_s = time.monotonic()
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        while True:
            self._due_s = time.monotonic() + _TICK_S
            time.sleep(_TICK_S)
            self.worst_ms = max(self.worst_ms, self.late_ms())

    def late_ms(self) -> float:
        """How long the tick now due has been waited for."""
        return max(0.0, time.monotonic() - self._due_s) * 1000

    def reset(self) -> None:
        """Forget the past."""
        self.worst_ms = 0.0


def emulators_late_ms(folder: object) -> float:
    """The latest turn of the emulators whose truth records are in the test's folder, whoever started them."""
    worst_ms = 0.0
    for truth in folder.rglob("truth*.jsonl") if isinstance(folder, Path) else ():
        for line in truth.read_text(encoding="utf-8").splitlines():
            if line.startswith(_LATE_RECORD) and line.endswith("}"):
                worst_ms = max(worst_ms, float(json.loads(line)["late_ms"]))
    return worst_ms


def shares(item: pytest.Item) -> bool:
    """Whether a test asks about what its file has made once for all, such as a drive."""
    definitions = item._fixtureinfo.name2fixturedefs  # type: ignore[attr-defined]
    return any(one.scope == "module" for found in definitions.values() for one in found)


class HostWatch:
    """The plugin: workers measure, the controller writes `report`."""

    def __init__(self, report: Path) -> None:
        self._report = report
        self._metronome = Metronome()
        self._failed: dict[str, int] = {}
        self._of_file: dict[Path, float] = {}

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_protocol(self) -> Generator[None, None, None]:
        """Begin anew with each test."""
        self._metronome.reset()
        yield

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_makereport(self, item: pytest.Item) -> Generator[None, pytest.CallInfo[None], None]:
        """Add to a report of failure how late the host was since the test began, 0 for a punctual one.

        What a file shares is made in the first test that asks for it, so lateness counts from there.
        """
        outcome = yield
        report = outcome.get_result()  # type: ignore[attr-defined]
        worst_ms = max(self._metronome.worst_ms, self._metronome.late_ms())
        self._of_file[item.path] = max(worst_ms, self._of_file.get(item.path, 0.0))
        if not report.failed:
            return
        folder = getattr(item, "funcargs", {}).get("tmp_path")
        since_ms = self._of_file[item.path] if shares(item) else worst_ms
        worst_ms = max(since_ms, emulators_late_ms(folder))
        report.user_properties.append((_KEY, round(worst_ms) if worst_ms > LATE_MS else 0))

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Collect what the workers say; a worker that died says nothing and counts as punctual."""
        if report.failed:
            late_ms = dict(report.user_properties).get(_KEY, 0)
            assert isinstance(late_ms, int)
            self._failed[report.nodeid] = max(late_ms, self._failed.get(report.nodeid, 0))

    def pytest_sessionfinish(self, session: pytest.Session, exitstatus: int) -> None:
        """Write what tools/dev decides by."""
        if hasattr(session.config, "workerinput"):
            return
        found = {"exit": int(exitstatus), "failed": self._failed}
        self._report.parent.mkdir(parents=True, exist_ok=True)
        self._report.write_text(json.dumps(found, indent=1) + "\n")


def watch_host(config: pytest.Config, folder: str) -> None:
    """Have the host watched during these tests; the report goes to build/FOLDER/host-late.json."""
    if not config.pluginmanager.has_plugin("host-watch"):
        config.pluginmanager.register(HostWatch(ROOT / "build" / folder / "host-late.json"), "host-watch")
