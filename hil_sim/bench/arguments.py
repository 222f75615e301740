# SPDX-License-Identifier: MIT
"""Arguments that the benches share."""

from __future__ import annotations

import argparse
import re
import sys
from typing import Final

from hil_sim.arguments import EXIT_USAGE as EXIT_USAGE
from hil_sim.arguments import Parser as Parser
from hil_sim.bench import plan

EXIT_FAILED = 1
_JOBS_MOST: Final = 4096


def seeds(text: str) -> range:
    """Return the seeds of A-B or of A."""
    match = re.fullmatch(r"(\d{1,15})(?:-(\d{1,15}))?", text)
    if not match or int(match[2] or match[1]) < int(match[1]):
        raise argparse.ArgumentTypeError(f"'{text}' is no range of seeds; write 1-20 or 7")
    return range(int(match[1]), int(match[2] or match[1]) + 1)


def listed(text: str) -> list[str]:
    """Return the parts of a list with commas."""
    return [part for part in text.split(",") if part]


def kinds(text: str) -> list[str]:
    """Return the kinds of a list with commas."""
    found = listed(text)
    for kind in found:
        if kind not in plan.KINDS:
            raise argparse.ArgumentTypeError(f"'{kind}' is no kind; there are {', '.join(plan.KINDS)}")
    return found


def jobs(text: str) -> int:
    """Return a number of processes."""
    if not text.isdigit() or not 1 <= int(text) <= _JOBS_MOST:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number of processes from 1 to {_JOBS_MOST}")
    return int(text)


def say(text: str) -> None:
    """Tell on standard error."""
    print(f"argus-sim: {text}", file=sys.stderr, flush=True)
