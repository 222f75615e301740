# SPDX-License-Identifier: MIT
"""The version of the project, as every program prints it for --version."""

from __future__ import annotations

import argparse
from typing import Final

# The one place where it is written; an installed program has it in its package's description.
_HEADER: Final = ("firmware", "include", "argus", "argus.h")
_DEFINED: Final = r'#define ARGUS_VERSION "([^"]+)"'


def version() -> str:
    """Return the version, "unknown" where neither the sources nor the package are there."""
    # These take as long to load as all else that a --help needs.
    import re
    from importlib import metadata
    from pathlib import Path

    try:
        match = re.search(
            _DEFINED, Path(__file__).resolve().parents[1].joinpath(*_HEADER).read_text(encoding="utf-8")
        )
    except OSError:
        match = None
    if match:
        return match[1]
    try:
        return metadata.version("argus-p3dx")
    except metadata.PackageNotFoundError:
        return "unknown"


class _Print(argparse.Action):
    """Prints the version and ends the program; it is looked up only when it is asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        print(f"{parser.prog} {version()}")
        parser.exit()


def add_version(parser: argparse._ActionsContainer) -> None:
    """Give a program the option --version."""
    parser.add_argument("--version", action=_Print, nargs=0, help="print the version and leave")
