# SPDX-License-Identifier: MIT
"""The `argus-log` command: finds the subcommands' modules and turns what goes wrong into one line."""

from __future__ import annotations

import argparse
import gc
import importlib
import io
import sys
from collections.abc import Sequence
from typing import Final, Protocol

from argus_tools.catalogue import HELP
from argus_tools.log.exits import EXIT_CODES, EXIT_READ, EXIT_UNUSABLE
from hil_sim.arguments import Parser
from hil_sim.errors import InputError, SimError, missing_package
from hil_sim.output import guarded, is_of_output
from hil_sim.start import EXIT_INTERRUPTED
from hil_sim.version import add_version

# What each command is for; its module has EXAMPLES, add_arguments(parser) and run(args) -> exit code.
COMMANDS: Final = {
    "decode": "print every packet of a log",
    "stats": "count packets, rates, gaps and damage, and describe each sonar",
    "faults": "tell what the fault manager would have said from a log alone",
    "plot": "draw readings over time, the path, or the sonar ring at one moment, as PNG or SVG",
    "convert": "write a log in another format",
    "replay": "serve a log as a robot, for any client",
    "diff": "show where two logs differ, packet by packet",
    "ring": "check and draw a ring of your own, FILE.toml",
}
# None of the commands' modules is needed for these.
_ASKS_FOR_HELP: Final = frozenset(("-h", "--help", "--version"))

_EPILOG = """\
examples:
  argus-log decode capture.bin                what a terminal program saved, packet by packet
  argus-log decode --json --follow live.rec   one JSON object per packet, as it comes
  argus-log stats drive.pcapng                counts, rates, gaps, and each sonar's record
  argus-log plot drive.rec -o drive.png       the readings of each sonar over time

formats:
{formats}
They are told apart by their contents and may be gzipped. For other forms it prints the name, and the command that
converts them.

{codes}
"""


class Command(Protocol):
    """What a subcommand's module offers."""

    EXAMPLES: str

    def add_arguments(self, parser: argparse.ArgumentParser) -> None:
        """Declare the subcommand's arguments."""

    def run(self, args: argparse.Namespace) -> int:
        """Do it; return the exit code."""


def _parser(first: str | None) -> argparse.ArgumentParser:
    """Return the parser for what begins so; only those commands are loaded that may be meant."""
    known = "".join(f"  {name:<11}{what}\n" for name, what in HELP.items())
    parser = Parser(
        prog="argus-log",
        description="Decodes, checks, converts, draws and replays logs of a robot's serial, TCP or CAN link.",
        epilog=_EPILOG.format(formats=known, codes=EXIT_CODES),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add_version(parser)
    subparsers = parser.add_subparsers(metavar="COMMAND", required=True, parser_class=Parser)
    for name in (first,) if first in COMMANDS else COMMANDS:
        subparser = subparsers.add_parser(
            name, help=COMMANDS[name], formatter_class=argparse.RawDescriptionHelpFormatter
        )
        if first is not None and first not in _ASKS_FOR_HELP:
            _fill(subparser, name)
    return parser


def _fill(parser: argparse.ArgumentParser, name: str) -> None:
    command: Command = importlib.import_module(f"argus_tools.log.{name}")
    parser.description = COMMANDS[name][0].upper() + COMMANDS[name][1:] + "."
    parser.epilog = f"examples:\n{command.EXAMPLES}\n{EXIT_CODES}\n"
    command.add_arguments(parser)
    parser.set_defaults(run=command.run)


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit code."""
    given = list(sys.argv[1:] if argv is None else argv)
    return guarded("argus-log", lambda: _run(given), EXIT_UNUSABLE, EXIT_READ)


def _run(given: Sequence[str]) -> int:
    if isinstance(sys.stdout, io.TextIOWrapper):  # a name may have letters that the terminal has not
        sys.stdout.reconfigure(errors="backslashreplace")
    # Millions of rows come and go here, none of them in a cycle.
    gc.set_threshold(100_000, 50, 50)
    args = _parser(given[0] if given else None).parse_args(given)
    from hil_sim.arcos.fields import PacketError

    try:
        code: int = args.run(args)
        sys.stdout.flush()
        return code
    except BrokenPipeError:
        raise
    except PacketError as error:
        print(f"argus-log: {getattr(args, 'log', 'the log')}: {error}", file=sys.stderr)
        return EXIT_UNUSABLE
    except (InputError, SimError) as error:
        print(f"argus-log: {error}", file=sys.stderr)
        return EXIT_UNUSABLE
    except ModuleNotFoundError as error:
        print(f"argus-log: {missing_package(error)}", file=sys.stderr)
        return EXIT_UNUSABLE
    except KeyboardInterrupt:
        return EXIT_READ if getattr(args, "follow", False) else EXIT_INTERRUPTED
    except OSError as error:
        if is_of_output(error):
            raise
        print(f"argus-log: {error.filename or 'output'}: {error.strerror}", file=sys.stderr)
        return EXIT_UNUSABLE


if __name__ == "__main__":
    sys.exit(main())
