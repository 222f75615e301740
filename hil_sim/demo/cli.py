# SPDX-License-Identifier: MIT
"""The demonstration: the emulator on a pty or a CAN bus, argusd on it, a judged drive, a report and a picture."""

from __future__ import annotations

import argparse
import dataclasses
import json
import math
import os
import re
import signal
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import NoReturn

from hil_sim.arguments import Parser
from hil_sim.core.library import setting_value
from hil_sim.demo import report
from hil_sim.demo.judge import (
    PAPER_LIMIT_S,
    TIME_LIMIT_S,
    Injected,
    Task,
    Verdict,
    clock_offset_s,
    judge,
)
from hil_sim.demo.live import view
from hil_sim.demo.runner import ENDING, Recording, Run, Setup
from hil_sim.demo.scene import Drive
from hil_sim.errors import InputError, SimError
from hil_sim.faults.grammar import parse_fault
from hil_sim.output import EXIT_UNREAD, guarded, is_of_output
from hil_sim.program import NO_ARGUSD, find_argusd
from hil_sim.scenario.scenario import SEED_MAX, Scenario, load_scenario
from hil_sim.world.files import load_world
from hil_sim.world.model import World

SCENARIOS = Path(__file__).resolve().parents[1] / "scenarios"
WORLDS = ("open-office", "demo", "smooth")
FIRST_FAULT_MM, NEXT_FAULT_MM = 600, 800
TRIES, TOO_LATE_MS = 3, 250.0
"""A drive that fails while the host is as late as that says nothing of Argus: so many are driven at most."""
TIMEOUT_S, LONGEST_S = 180.0, 3600.0

_EXAMPLES = """\
examples:
  tools/dev demo                            sonar 3 goes dead, later sonar 6 reads half the truth
  tools/dev demo --seed 7 --fail off:2,wrong:4
  tools/dev demo --policy fewest --out /tmp/drive
  tools/dev demo --profile paper --world demo    the paper's rules, under the conditions that they ask for
  tools/dev demo --no-live --json > drive.json
  tools/with-can .venv/bin/python -m hil_sim.demo --can vcan0 --no-live

exit codes: 0 goal reached, nothing hit, diagnosis equals injection; 1 the judge says no; 2 wrong arguments or files;
3 something could not be started; 129, 130, 143 ended by SIGHUP, Ctrl-C, SIGTERM; 141 nobody reads the output
"""


class _Ended(BaseException):
    """A signal asks for the end; not an `Exception`, so that nothing on the way out takes it for an error."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.number = number


def _faults(text: str) -> tuple[Injected, ...]:
    """`off:A,wrong:B`: one or two faults of different sonars of 1..6."""
    faults = []
    for part in text.split(","):
        match = re.fullmatch(r"(off|wrong):([1-6])", part.strip())
        if match is None:
            raise argparse.ArgumentTypeError(f"'{part}' is not off:N or wrong:N with a sonar N of 1 to 6")
        faults.append(Injected(match[1], int(match[2])))
    if len(faults) > 2 or len({fault.sonar for fault in faults}) < len(faults):
        raise argparse.ArgumentTypeError(
            f"'{text}': at most two faults, of different sonars, for example off:3,wrong:6"
        )
    return tuple(faults)


def _policy(text: str) -> str:
    """A word of the core's own list."""
    try:
        setting_value("policy", text)
    except InputError as error:
        raise argparse.ArgumentTypeError(str(error)) from error
    return text


def _seed(text: str) -> int:
    if not re.fullmatch(r"\d{1,19}", text) or int(text) > SEED_MAX:
        raise argparse.ArgumentTypeError(f"'{text}' is not a whole number from 0 to {SEED_MAX}")
    return int(text)


def _seconds(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 < value <= LONGEST_S:
        raise argparse.ArgumentTypeError(
            f"'{text}' is not a number of seconds above 0, up to {LONGEST_S:.0f}"
        )
    return value


def parser() -> argparse.ArgumentParser:
    """Return the argument parser of the demonstration."""
    result = Parser(
        prog="tools/dev demo",
        description=__doc__,
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    default = (Injected("off", 3), Injected("wrong", 6))
    result.add_argument(
        "--seed", type=_seed, default=1, metavar="N", help="seed of everything random (default 1)"
    )
    result.add_argument(
        "--fail",
        type=_faults,
        default=default,
        metavar="off:A,wrong:B",
        help="faults, in the order in which they come",
    )
    result.add_argument(
        "--policy",
        type=_policy,
        default="adaptive",
        metavar="NAME",
        help="planner, as argusd --list-config has them (default adaptive)",
    )
    result.add_argument(
        "--profile",
        choices=("argus", "paper"),
        default="argus",
        help="rules of the diagnosis (default argus)",
    )
    result.add_argument(
        "--world",
        choices=WORLDS,
        default="open-office",
        help="open-office (default): a glass wall and open floor; demo: rough walls, a box; smooth: smooth walls "
        "and 1 %% crosstalk",
    )
    result.add_argument(
        "--out", type=Path, default=Path("build/demo"), metavar="DIR", help="records and picture"
    )
    result.add_argument("--argusd", type=Path, default=find_argusd(), metavar="FILE", help="the program")
    result.add_argument(
        "--timeout",
        type=_seconds,
        default=TIMEOUT_S,
        metavar="S",
        help="longest drive (default %(default).0f)",
    )
    result.add_argument(
        "--can",
        metavar="IFACE[,...]",
        help="drive over a CAN bus, not a pty (as argus-sim --can, see docs/can.md)",
    )
    result.add_argument("--no-live", action="store_true", help="lines instead of a screen, on a terminal too")
    result.add_argument(
        "--json", action="store_true", help="the verdict as JSON on standard output, nothing else there"
    )
    return result


def _scenario(arguments: argparse.Namespace) -> Scenario:
    """The world's scenario with the faults and the seed asked for."""
    texts = []
    for number, fault in enumerate(arguments.fail):
        at = FIRST_FAULT_MM + number * NEXT_FAULT_MM
        texts.append(
            f"{fault.kind}:{fault.sonar}@travelled>{at}" + (":scale=0.5" if fault.kind == "wrong" else "")
        )
    scenario = load_scenario(SCENARIOS / f"{arguments.world}.yaml")
    return dataclasses.replace(
        scenario, seed=arguments.seed, faults=tuple(parse_fault(text) for text in texts)
    )


def _goal(scenario: Scenario, world: World) -> tuple[float, float]:
    """The goal in world axes; a course is driven from the start pose, whose heading is 0 in these worlds."""
    start = scenario.start or world.start
    if start.x_mm or start.y_mm or start.heading_deg:
        raise SimError(
            f"scenario {scenario.world}: the course is in the robot's frame, so the start must be 0, 0, 0"
        )
    return scenario.course[-1]


def _prepare(arguments: argparse.Namespace, scenario: Scenario) -> Setup:
    out: Path = arguments.out
    if arguments.argusd is None:
        raise SimError(NO_ARGUSD)
    try:
        out.mkdir(parents=True, exist_ok=True)
        (out / "course.csv").write_text(
            "# x_mm,y_mm\n" + "".join(f"{x:.0f},{y:.0f}\n" for x, y in scenario.course), encoding="utf-8"
        )
        (out / "argusd.conf").write_text(
            f"profile = {arguments.profile}\npolicy = {arguments.policy}\n", encoding="utf-8"
        )
        (out / "truth.jsonl").unlink(missing_ok=True)
    except OSError as error:
        raise SimError(f"{out}: {error.strerror}; name a folder that can be written with --out") from None
    scenario.save(out / "scenario.yaml")
    return Setup(
        out=out,
        argusd=arguments.argusd,
        sim_arguments=("--scenario", str(out / "scenario.yaml")),
        course=out / "course.csv",
        config=out / "argusd.conf",
        timeout_s=arguments.timeout,
        can=arguments.can or "",
    )


def _drive(arguments: argparse.Namespace, setup: Setup) -> Recording:
    shown = view(not arguments.no_live and not arguments.json)
    run = Run(setup, (lambda recording: None) if arguments.json else shown.show)
    try:
        return run()
    finally:
        shown.close()
        for note in run.notes:
            print(f"demo: {note}", file=sys.stderr)


def _title(arguments: argparse.Namespace) -> str:
    faults = ", then ".join(f"sonar {fault.sonar} {fault.kind}" for fault in arguments.fail)
    return f"Argus, one drive: {faults}   (world {arguments.world}, seed {arguments.seed}, policy {arguments.policy})"


def _conclude(
    arguments: argparse.Namespace, scenario: Scenario, recording: Recording, verdict: Verdict
) -> None:
    # What draws takes half a second to import: no wrong argument waits for it.
    from hil_sim.demo import picture

    path = arguments.out / "demo.png"
    picture.draw(
        Drive(
            world=load_world(scenario.world),
            course_mm=scenario.course,
            truth=recording.truth,
            events=recording.events,
            verdict=verdict,
            offset_s=clock_offset_s(recording.truth, recording.events),
            title=_title(arguments),
        ),
        path,
    )
    (arguments.out / "report.json").write_text(
        json.dumps(verdict.as_record(), indent=1) + "\n", encoding="utf-8"
    )
    if arguments.json:
        print(json.dumps(verdict.as_record() | {"ended": recording.ended, "picture": str(path)}))
        return
    colour = sys.stdout.isatty() and "NO_COLOR" not in os.environ
    print(f"\n{report.text(verdict, colour=colour)}\n")
    print(f"how it ended: {recording.ended}")
    print(f"picture: {path}   records: {arguments.out}/truth.jsonl, events.jsonl, report.json")


def _ended(number: int, _frame: FrameType | None) -> NoReturn:
    raise _Ended(number)


def _demonstrate(arguments: argparse.Namespace) -> int:
    scenario = _scenario(arguments)
    limit_s = PAPER_LIMIT_S if arguments.profile == "paper" else TIME_LIMIT_S
    task = Task(_goal(scenario, load_world(scenario.world)), arguments.fail, limit_s)
    for drive in range(1, TRIES + 1):
        setup = _prepare(arguments, scenario)
        if not arguments.json:
            takes = "two minutes" if arguments.profile == "paper" else "half a minute"
            print(f"demo: the drive takes about {takes}; records in {arguments.out}", flush=True)
        recording = _drive(arguments, setup)
        ended = time.monotonic()
        verdict = judge(recording.truth, recording.events, task)
        if verdict.passed or drive == TRIES or not is_too_late(verdict):
            break
        print(f"demo: {_again(verdict, drive)}", file=sys.stderr, flush=True)
    _conclude(arguments, scenario, recording, verdict)
    if not arguments.json:
        print(f"report and picture took {time.monotonic() - ended:.1f} s")
    sys.stdout.flush()
    return 0 if verdict.passed else 1


def is_too_late(verdict: Verdict) -> bool:
    """Whether the host, not Argus, may have failed the drive."""
    return max(verdict.host_late_ms, default=0.0) > TOO_LATE_MS


def _again(verdict: Verdict, drive: int) -> str:
    failed = ", ".join(rule.name for rule in verdict.rules if not rule.holds)
    late = f"the host was up to {max(verdict.host_late_ms):.0f} ms late"
    return f"not held: {failed}; but {late}, so it is driven again ({drive + 1} of {TRIES})"


@contextmanager
def _ending_signals() -> Iterator[None]:
    """Let a signal that ends this program end the drive first: without this a SIGTERM would leave argusd driving.

    What was ignored (nohup) stays ignored.
    """
    before = {number: signal.getsignal(number) for number in ENDING}
    for number, handler in before.items():
        if handler is not signal.SIG_IGN:
            signal.signal(number, _ended)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def main(argv: Sequence[str] | None = None) -> int:
    """Run the demonstration; return its exit code."""
    return guarded("demo", lambda: _main(argv), 2, EXIT_UNREAD)


def _main(argv: Sequence[str] | None) -> int:
    arguments = parser().parse_args(argv)
    try:
        with _ending_signals():
            return _demonstrate(arguments)
    except SimError as error:
        print(f"demo: {error}", file=sys.stderr)
        return error.exit_code
    except (_Ended, KeyboardInterrupt) as error:
        print("demo: interrupted; the robot was stopped and both programs have ended", file=sys.stderr)
        return 128 + (error.number if isinstance(error, _Ended) else signal.SIGINT)
    except OSError as error:
        if isinstance(error, BrokenPipeError) or is_of_output(error):
            raise
        print(f"demo: {error.filename}: {error.strerror}; name another folder with --out", file=sys.stderr)
        return 2
