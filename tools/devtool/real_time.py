# SPDX-License-Identifier: MIT
"""Tests in real time: how many run at once, and which are run again because the host was late."""

from __future__ import annotations

import dataclasses
import json
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from devtool.base import CORES, VENV, Command, Run, paint, quiet_ok, say
from devtool.stages import StageFailed, children_cpu_s

TESTS_FAILED: Final = 1
"""The exit code of pytest when tests failed and nothing else was wrong."""


@dataclasses.dataclass(frozen=True)
class Lateness:
    """What tests/hil/lateness.py found: failed tests, and how late the host was meanwhile; 0 if it was
    punctual."""

    exit_code: int
    failed: Mapping[str, int]

    @property
    def punctual(self) -> tuple[str, ...]:
        """Those that failed though the host was punctual."""
        return tuple(name for name, late_ms in self.failed.items() if not late_ms)


def read_lateness(report: Path) -> Lateness:
    """Read the report; without one nothing is known to have failed."""
    try:
        found = json.loads(report.read_text(encoding="utf-8"))
    except OSError:
        return Lateness(0, {})
    return Lateness(found["exit"], found["failed"])


def to_repeat(found: Lateness) -> tuple[str, ...]:
    """Return the tests to run again: all that failed if each did while the host was late, else none."""
    return tuple(found.failed) if found.exit_code == TESTS_FAILED and not found.punctual else ()


def say_late(found: Lateness) -> None:
    """Tell what failed while the host was late, before it is run again."""
    say(paint("THE HOST WAS LATE while these tests failed, which says nothing of Argus:", "33"))
    for name, late_ms in found.failed.items():
        say(f"  {late_ms:5} ms late  {name}")
    say("running exactly these again, one at a time")


def run_in_real_time(
    run: Run, pytest: Command, tests: Sequence[str], workers: int, report: Path
) -> str | None:
    """Run TESTS with WORKERS, and once more, each alone, what failed while the host was late; return what to tell.

    A robot, its line and argusd are three clocks of one host: a test of how soon it stands, or of what is on a bus each
    second, cannot be asked of virtual time. Every other test waits for what the robot does, however long that takes.
    """
    report.unlink(missing_ok=True)
    try:
        run([*pytest, "-n", str(workers), *tests])
    except StageFailed as error:
        late = read_lateness(report)
        if not to_repeat(late):
            raise StageFailed(f"{error}{_why(late)}") from None
    else:
        return None
    say_late(late)
    report.unlink(missing_ok=True)
    try:
        run([*pytest, "-n", "1", *late.failed])
    except StageFailed as error:
        found = read_lateness(report)
        why = "; the host was late even for one test at a time" if to_repeat(found) else _why(found)
        raise StageFailed(f"{error}{why}") from None
    worst_ms = max(late.failed.values())
    return f"passed only when run again, the host was up to {worst_ms} ms late: {', '.join(late.failed)}"


def _why(found: Lateness) -> str:
    return f"; failed though the host was punctual: {', '.join(found.punctual)}" if found.punctual else ""


SPIN: Final = """import time
begin, busy = time.monotonic(), time.process_time()
while time.monotonic() < begin + 1:
    pass
print(time.process_time() - busy)
"""


def core_part() -> float:
    """Return what part of a core a busy program gets when there is one on each; the rest is others' or no core."""
    command = [sys.executable, "-c", SPIN]
    spinning = [subprocess.Popen(command, stdout=subprocess.PIPE, text=True) for _ in range(CORES)]
    return sum(float(child.communicate()[0]) for child in spinning) / CORES


def start_cpu_s() -> float:
    """Return the CPU time that it takes to start argus-sim; the first of three may have to compile it."""
    took = []
    for _ in range(3):
        before_s = children_cpu_s()
        if not quiet_ok([VENV / "bin/argus-sim", "--list-worlds"]):
            raise StageFailed("argus-sim does not start")
        took.append(children_cpu_s() - before_s)
    return min(took)


WORKER_STARTS: Final = 0.25
"""CPU time a worker takes in a second, in starts of argus-sim. A running emulator is no measure: a busy host makes it
do more in fewer turns, and so seem cheaper."""
FILLED: Final = 0.6
"""How much of the machine tests may take on average, so that none waits for a core."""

MOST_A_CORE: Final = 7
"""So many tests at most for each core: what they start is begun at the same moment at times."""


def worker_count(cores: int, core: float, start_s: float) -> int:
    """Return how many tests in real time may run at once on CORES of which the part CORE is to be had."""
    fits = int(FILLED * cores * core / (WORKER_STARTS * max(start_s, 1e-3)))
    return min(max(fits, 2), MOST_A_CORE * cores)


def hil_workers() -> int:
    """Measure this machine and tell how many tests in real time it is given at once."""
    core, start_s = core_part(), start_cpu_s()
    workers = worker_count(CORES, core, start_s)
    say(
        f"{workers} tests at once: an emulator starts with {start_s:.2f} s of CPU, "
        f"and {100 * core:.0f} % of each of {CORES} cores are to be had"
    )
    return workers
