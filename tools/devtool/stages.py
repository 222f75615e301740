# SPDX-License-Identifier: MIT
"""Commands that consist of stages: all of them are run, each with a log, and the end lists what failed."""

from __future__ import annotations

import argparse
import dataclasses
import os
import re
import resource
import signal
import subprocess
import textwrap
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from devtool.base import (
    EXIT_FAILED,
    EXIT_USAGE,
    LOGS,
    ROOT,
    Command,
    Run,
    Stop,
    environment,
    line_of,
    paint,
    say,
    shown,
    words,
)
from devtool.beside import beside, yield_cores
from devtool.setup import ensure
from hil_sim.arguments import offer

STAGE_LIMIT_S: Final = 5400.0
"""A guard against what hangs: many times what a stage takes, so that no busy host trips it."""

GRACE_S: Final = 60.0
"""So long a program may take to end what it has started."""

PROGRESS: Final = re.compile(
    r"\[ *\d+[/%].*\] (Building|Linking|Built) |tests/.*:PASS$| +Start +\d+: | *\d+/\d+ Test .* Passed "
)
SHOWN_LINES: Final = 150


LINE_MOST: Final = 160
"""Characters of a command in a message: that of clang-format names every C file."""


class StageFailed(Exception):
    """A command of a stage failed; the stage's log tells why."""


@dataclasses.dataclass(frozen=True)
class Stage:
    """One named step of a check, with what it needs to run."""

    name: str
    what: str
    action: Callable[[Run], str | None]
    """Raises StageFailed, or returns what is to be said although all is well."""
    presets: tuple[str, ...] = ()
    needs: tuple[str, ...] = ()
    real_time: bool = False
    """It waits for robots most of the time, and they must not wait for a core: others run behind it meanwhile."""


@dataclasses.dataclass(frozen=True)
class Spent:
    """Time that was spent: by the clock, and of CPU."""

    seconds: float = 0.0
    cpu_s: float = 0.0

    def __add__(self, other: Spent) -> Spent:
        return Spent(self.seconds + other.seconds, self.cpu_s + other.cpu_s)

    def __sub__(self, other: Spent) -> Spent:
        return Spent(self.seconds - other.seconds, self.cpu_s - other.cpu_s)


@dataclasses.dataclass(frozen=True)
class Result:
    """How a stage ended: why it failed, if it did, what it took, what of that its building took, and what to tell."""

    failure: str | None
    spent: Spent
    made: Spent
    log: Path
    note: str | None = None

    @property
    def passed(self) -> bool:
        """It did not fail."""
        return self.failure is None


def children_cpu_s() -> float:
    """Return the CPU time of all children that have ended, and theirs."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def now() -> Spent:
    """Return the clock, and the CPU time of our children."""
    return Spent(time.monotonic(), children_cpu_s())


_made = Spent()


@contextmanager
def making() -> Iterator[None]:
    """Count what is spent in here as building: it is told apart from what the tests take."""
    global _made
    start = now()
    try:
        yield
    finally:
        _made += now() - start


@contextmanager
def process_group(command: Command, log: Path, verbose: bool) -> Iterator[subprocess.Popen[bytes]]:
    """Start COMMAND in a group of its own, which is killed if this is left before its end: children of a test, too."""
    with log.open("a") as file:
        file.write(f"$ {line_of(command)}\n")
        file.flush()
        child = subprocess.Popen(
            words(command),
            cwd=ROOT,
            env=environment(),
            stdin=subprocess.DEVNULL,
            stdout=None if verbose else file,
            stderr=None if verbose else subprocess.STDOUT,
            start_new_session=True,
        )
        yield_cores(child.pid)
        try:
            yield child
        except BaseException:
            end_group(child)
            raise


def end_group(child: subprocess.Popen[bytes]) -> None:
    """End a program with all of its group; it may end first what it has started in groups of their own."""
    with suppress(ProcessLookupError):
        os.killpg(child.pid, signal.SIGTERM)
    with suppress(subprocess.TimeoutExpired):
        child.wait(GRACE_S)
    with suppress(ProcessLookupError):
        os.killpg(child.pid, signal.SIGKILL)
    child.wait()


def logged_runner(log: Path, verbose: bool, limit_s: float) -> Run:
    """Return a runner whose output goes to LOG, or to the terminal when VERBOSE; it ends in LIMIT_S."""
    deadline = time.monotonic() + limit_s

    def run(command: Command) -> None:
        line = textwrap.shorten(line_of(command), LINE_MOST, placeholder=" ...")
        try:
            with process_group(command, log, verbose) as child:
                code = child.wait(timeout=max(1.0, deadline - time.monotonic()))
        except subprocess.TimeoutExpired:
            raise StageFailed(f"not done after {limit_s:.0f} s: {line}") from None
        except OSError as error:
            raise StageFailed(f"{error.strerror}: {line}") from None
        if code:
            raise StageFailed(f"exit code {code}: {line}")

    return run


def tail_of(log: Path, lines: int = SHOWN_LINES) -> str:
    """Return the end of LOG: at most LINES, of the last command only, without what went well."""
    text = log.read_text(errors="replace")
    last = text[text.rfind("\n$ ") + 1 :].splitlines()
    return "\n".join([line for line in last if not PROGRESS.match(line)][-lines:])


def run_stage(stage: Stage, verbose: bool) -> Result:
    """Run STAGE."""
    LOGS.mkdir(parents=True, exist_ok=True)
    log = LOGS / f"{stage.name}.log"
    log.write_text("")
    say(f"{stage.name}: {stage.what}")
    start, made = now(), _made
    failure = note = None
    try:
        note = stage.action(logged_runner(log, verbose, STAGE_LIMIT_S))
    except (StageFailed, Stop) as error:
        failure = str(error)
        if not verbose:
            print(tail_of(log), flush=True)
        say(paint(f"{stage.name} FAILED: {failure} (log: {shown(log)})", "31"))
    return Result(failure, now() - start, _made - made, log, note)


def verdict(good: bool) -> str:
    """Return one word in colour, as wide either way."""
    return paint("ok    ", "32") if good else paint("FAILED", "31")


def table_line(name: str, good: bool, spent: Spent, made: Spent) -> str:
    """Return a line of the table: by the clock, of CPU, and what of that the building took."""
    tests = spent - made
    return (
        f"  {name:<14} {verdict(good)} {spent.seconds:7.1f} s  CPU {spent.cpu_s:7.1f} s"
        f" = {tests.cpu_s:6.1f} s tests + {made.cpu_s:6.1f} s building"
    )


def table_lines(
    stages: Sequence[Stage], results: Mapping[str, Result], set_up: Spent, seconds: float
) -> Iterator[str]:
    """Yield a line for what was set up, for each of STAGES, and their sum; all of it took SECONDS by the clock."""
    yield table_line("set-up", True, set_up, set_up)
    for stage in stages:
        result = results.get(stage.name)
        if result is None:
            yield f"  {stage.name:<14} not run"
            continue
        yield table_line(stage.name, result.passed, result.spent, result.made)
        if result.note:
            yield paint(f"  {'':<14} {result.note}", "33")
    good = len(results) == len(stages) and all(result.passed for result in results.values())
    spent = sum((result.spent for result in results.values()), set_up)
    made = sum((result.made for result in results.values()), set_up)
    yield table_line("total", good, Spent(set_up.seconds + seconds, spent.cpu_s), made)


def failed_lines(results: Mapping[str, Result]) -> Iterator[str]:
    """Yield what failed, with the log of each; nothing if all is well."""
    failed = {name: result for name, result in results.items() if not result.passed}
    if failed:
        yield paint(f"failed: {', '.join(failed)}", "31")
    for name, result in failed.items():
        yield f"  {name:<14} {shown(result.log)}: {result.failure}"


def run_in_turn(stages: Sequence[Stage], keep_going: bool, verbose: bool) -> dict[str, Result]:
    """Run STAGES one after another, to the end or until one fails."""
    results: dict[str, Result] = {}
    for stage in stages:
        results[stage.name] = run_stage(stage, verbose)
        if not results[stage.name].passed and not keep_going:
            break
    return results


def run_beside(stages: Sequence[Stage]) -> dict[str, Result]:
    """Run those in real time, which leave the cores idle most of the time, one after another; the others behind them.

    Of two that run in real time each would make the other's robots late.
    """
    timed = [stage for stage in stages if stage.real_time]
    others = [stage for stage in stages if not stage.real_time]
    with beside(lambda: run_in_turn(others, True, False)) as result_of_others:
        results = run_in_turn(timed, True, False)
        try:
            results |= result_of_others()
        except EOFError:
            raise Stop("what ran beside the stages in real time ended without a result") from None
    return {stage.name: results[stage.name] for stage in stages}


def run_stages(stages: Sequence[Stage], keep_going: bool, verbose: bool, set_up: Spent | None = None) -> int:
    """Run STAGES, print the summary, and return the exit code.

    One after another where the first failure ends all, where the output of each is to be read, or where all are alike.
    """
    start_s = time.monotonic()
    mixed = len({stage.real_time for stage in stages}) > 1
    results = (
        run_beside(stages)
        if mixed and keep_going and not verbose
        else run_in_turn(stages, keep_going, verbose)
    )
    print()
    table = table_lines(stages, results, set_up or Spent(), time.monotonic() - start_s)
    for line in (*table, *failed_lines(results)):
        print(line, flush=True)
    return 0 if all(result.passed for result in results.values()) else EXIT_FAILED


def chosen(stages: Sequence[Stage], only: Sequence[str]) -> list[Stage]:
    """Return the stages named in ONLY, or all of them."""
    names = [stage.name for stage in stages]
    for name in only:
        if name not in names:
            raise Stop(f"no stage '{name}'{offer(name, names)}", EXIT_USAGE)
    return [stage for stage in stages if not only or stage.name in only]


def add_stage_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of the commands that consist of stages."""
    parser.add_argument(
        "--only", metavar="STAGE", action="append", default=[], help="run this stage (may be repeated)"
    )
    parser.add_argument("--list", action="store_true", help="print the stages and do nothing")
    parser.add_argument(
        "--keep-going",
        action=argparse.BooleanOptionalAction,
        default=True,
        help="go on after a stage that failed (as is done without this option), or end there",
    )
    parser.add_argument("--verbose", action="store_true", help="show the output of stages that pass, too")


def staged_command(args: argparse.Namespace, stages: Sequence[Stage]) -> int:
    """Carry out a command that consists of stages, with the options all of those share."""
    if args.list:
        for stage in stages:
            print(f"{stage.name:<14} {stage.what}")
        return 0
    todo = chosen(stages, args.only)
    start = now()
    ensure(
        [preset for stage in todo for preset in stage.presets],
        [need for stage in todo for need in stage.needs],
    )
    return run_stages(todo, args.keep_going, args.verbose, now() - start)
