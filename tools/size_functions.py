#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks length and cyclomatic complexity of the C functions in firmware/ and hal/."""

from __future__ import annotations

import argparse
import statistics
import sys
from pathlib import Path

import lizard

ROOT = Path(__file__).resolve().parent.parent
MAX_COMPLEXITY = 10
MAX_LINES = 60
MAX_MEDIAN = {"firmware": 12}

EPILOG = """examples:
  .venv/bin/python tools/size_functions.py
  .venv/bin/python tools/size_functions.py --worst 10

exit codes: 0 within the limits, 1 beyond them"""


def functions(folder: Path) -> list[tuple[str, int, int]]:
    """Return (place and name, lines, cyclomatic complexity) of each C function below FOLDER."""
    found = []
    for path in sorted(folder.rglob("*.c")):
        for one in lizard.analyze_file(str(path)).function_list:
            place = f"{path.relative_to(folder.parent)}:{one.start_line}: {one.name}"
            found.append((place, one.end_line - one.start_line + 1, one.cyclomatic_complexity))
    return found


def offences(folder: str, found: list[tuple[str, int, int]]) -> list[str]:
    """Return one line for each limit that FOLDER breaks."""
    lines = []
    for place, length, complexity in found:
        if length > MAX_LINES:
            lines.append(f"{place}: {length} lines, at most {MAX_LINES}; split it")
        if complexity > MAX_COMPLEXITY:
            lines.append(f"{place}: cyclomatic complexity {complexity}, at most {MAX_COMPLEXITY}; split it")
    limit = MAX_MEDIAN.get(folder)
    if limit is not None and found and statistics.median(row[1] for row in found) > limit:
        lines.append(f"{folder}: the median function is longer than {limit} lines; split the long ones")
    return lines


def main(argv: list[str] | None = None) -> int:
    """Run the command line and return its exit code."""
    parser = argparse.ArgumentParser(
        prog="tools/size_functions.py",
        description=__doc__,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "--worst", type=int, default=0, metavar="N", help="print the N longest functions, too"
    )
    args = parser.parse_args(argv)
    broken = []
    for folder in ("firmware", "hal"):
        found = functions(ROOT / folder)
        if not found:
            broken.append(f"{folder}: no C function found")
            continue
        lengths = [row[1] for row in found]
        print(
            f"{folder}: {len(found)} functions, median {statistics.median(lengths):g} lines, "
            f"longest {max(lengths)}, highest complexity {max(row[2] for row in found)}"
        )
        for place, length, complexity in sorted(found, key=lambda row: -row[1])[: args.worst]:
            print(f"  {length:3} lines, complexity {complexity:2}: {place}")
        broken += offences(folder, found)
    print("".join(line + "\n" for line in broken), end="", file=sys.stderr)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
