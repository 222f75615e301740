# SPDX-License-Identifier: MIT
"""The `argus-conformance` command: runs the checks against a target and prints what was observed."""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Final

from hil_sim.arguments import Parser, meant
from hil_sim.conformance.check import Check
from hil_sim.conformance.checks import CHECKS, GROUPS
from hil_sim.conformance.client import Client, Failed, NotApplicable, Target, parse_target
from hil_sim.errors import SimError
from hil_sim.output import EXIT_UNREAD, guarded
from hil_sim.start import EXIT_INTERRUPTED
from hil_sim.version import add_version

PASS, FAIL, NOT_APPLICABLE = "pass", "fail", "not applicable"
_COLOURS: Final = {PASS: "32", FAIL: "31", NOT_APPLICABLE: "33"}

_EXAMPLES = """\
examples:
  argus-conformance --target tcp:localhost:8101                 what stands still, then asks before it drives
  argus-conformance --target serial:/dev/ttyUSB0@9600 --motion  a robot, on blocks or with a metre free around it
  argus-conformance --target serial:/dev/pts/5 --only sonar --json
  argus-conformance --list

A check that moves the robot (at most 0.4 m and 400 mm/s) runs with --motion, or when you say yes on a terminal;
otherwise it is not applicable.

exit codes: 0 no check failed, 1 a check failed, 2 wrong argument, 3 the target cannot be reached
"""


@dataclass(frozen=True)
class Result:
    """What one check came to."""

    check: str
    verdict: str
    observed: str
    expected: str
    seconds: float


def run_check(check: Check, client: Client, motion: bool) -> Result:
    """Run one check; whatever the target does becomes a verdict."""
    began = time.monotonic()
    if check.motion and not motion:
        verdict, observed = NOT_APPLICABLE, "needs --motion"
    else:
        try:
            verdict, observed = PASS, check.run(client)
        except NotApplicable as reason:
            verdict, observed = NOT_APPLICABLE, str(reason)
        except Failed as failure:
            verdict, observed = FAIL, str(failure)
    if check.motion and motion:
        client.halt()
    return Result(check.title, verdict, observed, check.expects, round(time.monotonic() - began, 2))


def selected(only: Sequence[str]) -> list[Check]:
    """The checks of the given groups or GROUP/NAMEs; all when none are given."""
    known = {item.title for item in CHECKS} | set(GROUPS) | {item.name for item in CHECKS}
    for name in only:
        if name not in known:
            raise SimError(
                f"--only {name}: no such check or group{meant(name, known)}; see argus-conformance --list"
            )
    return [c for c in CHECKS if not only or {c.title, c.group, c.name} & set(only)]


def run(
    target: Target, checks: Sequence[Check], motion: bool, tell: Callable[[Result], None] = lambda _: None
) -> list[Result]:
    """Run checks one after the other on one connection; raises LinkError when the target cannot be reached."""
    client = Client(target)
    client.open()
    results = []
    try:
        for check in checks:
            results.append(run_check(check, client, motion))
            tell(results[-1])
    finally:
        client.close()
    return results


def _paint(text: str, verdict: str) -> str:
    wanted = sys.stdout.isatty() and "NO_COLOR" not in os.environ and os.environ.get("TERM") != "dumb"
    return f"\033[{_COLOURS[verdict]}m{text}\033[0m" if wanted else text


def _print(result: Result) -> None:
    print(
        f"{_paint(f'{result.verdict:14}', result.verdict)}  {result.check:32}  {result.observed}", flush=True
    )
    if result.verdict == FAIL:
        print(f"{'':14}  {'':32}  expected: {result.expected}", flush=True)


def _may_move(arguments: argparse.Namespace, checks: Sequence[Check]) -> bool:
    """Whether the robot may be moved: asked for, or agreed to on a terminal."""
    if arguments.motion or not any(check.motion for check in checks):
        return bool(arguments.motion)
    if arguments.json or not (sys.stdin.isatty() and sys.stdout.isatty()):
        return False
    print(
        "The target will drive up to 0.4 m to and fro, and turn. Is there a metre free around it? [y/N] ",
        end="",
    )
    return sys.stdin.readline().strip().lower() in ("y", "yes")


def parser() -> argparse.ArgumentParser:
    """Return the argument parser."""
    result = Parser(
        prog="argus-conformance",
        description="Check an ARCOS server, robot or emulator, from outside.",
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    result.add_argument("--target", metavar="TARGET", help="tcp:HOST:PORT or serial:PATH[@BAUD]")
    result.add_argument(
        "--only", action="append", default=[], metavar="NAME", help="a group or check; repeatable"
    )
    result.add_argument(
        "--motion", action="store_true", help="run the checks that move the robot, without asking"
    )
    result.add_argument("--json", action="store_true", help="one JSON object per check instead of the table")
    result.add_argument("--list", action="store_true", help="list the checks and leave")
    add_version(result)
    return result


def main(argv: Sequence[str] | None = None) -> int:
    """Run `argus-conformance`; return its exit code."""
    return guarded("argus-conformance", lambda: _run(argv), 2, EXIT_UNREAD)


def _run(argv: Sequence[str] | None) -> int:
    arguments = parser().parse_args(argv)
    try:
        checks = selected(arguments.only)
        if arguments.list:
            _list(checks)
            return 0
        return _check_target(arguments, checks)
    except SimError as error:
        print(f"argus-conformance: {error}", file=sys.stderr)
        return 3 if error.exit_code == 1 else 2
    except KeyboardInterrupt:
        return EXIT_INTERRUPTED


def _list(checks: Sequence[Check]) -> None:
    for check in checks:
        print(f"{check.title:32}  {'moves' if check.motion else '     '}  {check.expects}")


def _check_target(arguments: argparse.Namespace, checks: Sequence[Check]) -> int:
    if not arguments.target:
        raise SimError("--target is needed: tcp:HOST:PORT or serial:PATH[@BAUD]")
    target = parse_target(arguments.target)
    motion = _may_move(arguments, checks)
    tell = (lambda r: print(json.dumps(asdict(r)), flush=True)) if arguments.json else _print
    results = run(target, checks, motion, tell)
    verdicts = Counter(result.verdict for result in results)
    if not arguments.json:
        print(", ".join(f"{verdicts[verdict]} {verdict}" for verdict in _COLOURS))
    return 1 if verdicts[FAIL] else 0


if __name__ == "__main__":
    sys.exit(main())
