# SPDX-License-Identifier: MIT
"""The command line of `argus-sim experiment`."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from argus_tools.formats.base import LogError

from hil_sim.bench.arguments import EXIT_USAGE, Parser, jobs, listed, say, seeds
from hil_sim.errors import SimError
from hil_sim.experiment import journey
from hil_sim.experiment.cases import POLICIES, WORLDS

PROG: Final = "argus-sim experiment"


def parser() -> argparse.ArgumentParser:
    """Return the argument parser."""
    result = Parser(prog=PROG, allow_abbrev=False)
    result.add_argument("what", choices=("journey",))
    result.add_argument("--masks", default="all")
    result.add_argument("--worlds", type=listed, default=list(WORLDS))
    result.add_argument("--seeds", type=seeds, default=range(1, 11))
    result.add_argument("--policies", type=listed, default=list(POLICIES))
    result.add_argument("--day", default="plain")
    result.add_argument("--one")
    result.add_argument("--jobs", type=jobs, default=os.cpu_count() or 1)
    result.add_argument("--out", type=Path, default=Path("experiment"))
    result.add_argument("--resume", action="store_true")
    result.add_argument("--fresh", action="store_true")
    return result


def main(argv: Sequence[str]) -> int:
    """Run `argus-sim experiment ARGV`; return the exit code."""
    arguments = parser().parse_args(argv)
    try:
        if arguments.one:
            print(journey.show_one(arguments.one), end="")
            return 0
        return journey.run_study(arguments, arguments.out)[0]
    except SimError as error:
        say(str(error))
        return error.exit_code
    except LogError as error:
        say(str(error))
        return EXIT_USAGE
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
