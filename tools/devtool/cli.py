# SPDX-License-Identifier: MIT
"""The command line of tools/dev."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from typing import Final

from devtool import commands, docs, firmware, mutation, packaging, proofs, supply
from devtool.base import Action, Add, Stop, leave_at_sigterm
from devtool.cmake import presets
from devtool.coverage import do_coverage
from devtool.linting import LINT_STAGES, format_stages
from devtool.setup import leave_venv
from devtool.stages import add_stage_options, staged_command
from devtool.testing import QUICK_STAGES, SOAK_STAGES, TEST_STAGES
from hil_sim.arguments import EXIT_USAGE, Parser
from hil_sim.output import EXIT_UNREAD, guarded
from hil_sim.start import EXIT_INTERRUPTED

WHAT: Final = (
    "The one command of the project: sets everything up, then demonstrates, tests, builds or measures Argus."
)
EXIT_CODES: Final = """exit codes: 0 done, 1 something failed, 2 wrong arguments,
            3 the machine lacks something (the message gives the command that adds it)"""
HANDED_ON: Final = ("demo", "shell")
"""What follows these is not ours, except a leading --help."""


def do_test(args: argparse.Namespace) -> int:
    """Run all tests, or the quick ones."""
    return staged_command(args, QUICK_STAGES if args.quick else TEST_STAGES)


def do_soak(args: argparse.Namespace) -> int:
    """Run what computes for long, with the sweeps that no change waits for."""
    return staged_command(args, SOAK_STAGES)


def do_format(args: argparse.Namespace) -> int:
    """Lay out all sources."""
    return staged_command(args, format_stages(args.check))


def do_lint(args: argparse.Namespace) -> int:
    """Check the sources without running them."""
    return staged_command(args, (*format_stages(True), *LINT_STAGES))


def add_running(add: Add) -> None:
    """Add the commands that run Argus."""
    demo = add(
        "demo",
        commands.do_demo,
        "drive the emulated robot round a box while its sonars fail; passes its arguments on",
        "demo\ndemo --seed 7 --fail off:3,wrong:6\ndemo -- --help",
    )
    demo.add_argument(
        "rest", metavar="ARGUMENT", nargs="*", help="argument of the demonstration, e.g. --seed 7"
    )
    shell = add(
        "shell",
        commands.do_shell,
        "open a shell in which argusd, argus-sim and argus-log are in PATH, or run a command so",
        "shell\nshell argus-sim --list-worlds",
    )
    shell.add_argument("rest", metavar="WORD", nargs="*", help="command to run (default: your shell)")


def add_checking(add: Add) -> None:
    """Add the commands that consist of stages."""
    test = add(
        "test",
        do_test,
        "run every test: C on four builds, Cortex-M4, Python, and the loop over ptys and CAN buses",
        "test\ntest --quick\ntest --only release --only python\ntest --no-keep-going",
    )
    test.add_argument(
        "--quick", action="store_true", help="only those that take seconds and need no robot in real time"
    )
    add_stage_options(test)
    soak = add(
        "soak",
        do_soak,
        "run the tests that compute for long, with the wide sweeps that `test` leaves out",
        "soak\nsoak --only wide",
    )
    add_stage_options(soak)
    formatter = add("format", do_format, "lay out all C and Python sources", "format\nformat --check")
    formatter.add_argument(
        "--check", action="store_true", help="change nothing, exit 1 if something would change"
    )
    add_stage_options(formatter)
    linter = add("lint", do_lint, "check layout, defects, complexity and types", "lint\nlint --only mypy")
    add_stage_options(linter)


def add_making(add: Add) -> None:
    """Add the commands that build and measure."""
    builder = add(
        "build", commands.do_build, f"build presets: {', '.join(presets())}", "build\nbuild release m32"
    )
    builder.add_argument("preset", metavar="PRESET", nargs="*", help="what to build (default: release)")
    reached = add(
        "coverage",
        do_coverage,
        "measure which lines and branches of firmware/ its C unit tests reach",
        "coverage\ncoverage --mcdc\ncoverage --hil",
    )
    how = reached.add_mutually_exclusive_group()
    how.add_argument(
        "--mcdc", action="store_true", help="by clang 18 or later: what each condition decides by itself, too"
    )
    how.add_argument(
        "--hil", action="store_true", help="hal/ and argusd, too, with all tests, those over ptys included"
    )
    add("size", commands.do_size, "print text, RAM per instance and worst stack on Cortex-M4", "size")
    add("api", commands.do_api, "make the pages of the public header, build/api/index.html", "api")
    figures = add(
        "figures",
        commands.do_figures,
        "write the measured figures into the documents, from docs/figures",
        "figures\nfigures --check",
    )
    figures.add_argument("--check", action="store_true", help="change nothing, exit 1 if out of date")
    bench = add(
        "bench", commands.do_bench, "run the benchmarks of tests/bench", "bench\nbench NAME\nbench --can"
    )
    bench.add_argument("--can", action="store_true", help="those on a CAN bus, through tools/with-can")
    bench.add_argument("name", metavar="NAME", nargs="*", help="benchmark to run (default: all)")
    clean = add("clean", commands.do_clean, "remove build results and caches", "clean\nclean --all")
    clean.add_argument("--all", action="store_true", help="remove downloads and .venv, too")


def make_parser() -> argparse.ArgumentParser:
    """Return the parser of the whole command line."""
    parser = Parser(
        prog="tools/dev",
        description=WHAT,
        epilog="examples:\n  tools/dev demo\n  tools/dev test\n  tools/dev test --help\n\n" + EXIT_CODES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    subparsers = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)

    def add(name: str, action: Action, what: str, examples: str) -> argparse.ArgumentParser:
        indented = "".join(f"  tools/dev {line}\n" for line in examples.split("\n"))
        sub = subparsers.add_parser(
            name,
            help=what,
            description=what[0].upper() + what[1:] + ".",
            epilog=f"examples:\n{indented}\n{EXIT_CODES}",
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        sub.set_defaults(action=action)
        return sub

    for add_some in (
        add_running,
        add_checking,
        add_making,
        docs.add_commands,
        firmware.add_commands,
        packaging.add_commands,
        proofs.add_commands,
        mutation.add_commands,
        supply.add_commands,
    ):
        add_some(add)
    return parser


def parse(argv: Sequence[str]) -> argparse.Namespace:
    """Parse ARGV."""
    words = list(argv)
    parser = make_parser()
    if words[:1] and words[0] in HANDED_ON and words[1:2] not in (["-h"], ["--help"]):
        args = parser.parse_args(words[:1])
        args.rest = words[2:] if words[1:2] == ["--"] else words[1:]
        return args
    return parser.parse_args(words)


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code."""
    words = sys.argv[1:] if argv is None else argv
    return guarded("dev", lambda: _main(words), EXIT_USAGE, EXIT_UNREAD)


def _main(argv: Sequence[str]) -> int:
    args = parse(argv)
    leave_venv()
    leave_at_sigterm()
    action: Action = args.action
    try:
        return action(args)
    except Stop as stop:
        print(f"dev: {stop}", file=sys.stderr)
        return stop.code
    except KeyboardInterrupt:
        print("dev: interrupted", file=sys.stderr)
        return EXIT_INTERRUPTED
