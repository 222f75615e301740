#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Write the measured figures into the documents, from the result files in docs/figures.

A bench leaves its figures as JSON. The file that is published lies in docs/figures, and every table of the
documents is made of it. To publish a new run, copy its JSON there and run this tool.
"""

from __future__ import annotations

import argparse
import functools
import json
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

ROOT: Final = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))
sys.path.insert(0, str(ROOT / "tools"))

import marked  # noqa: E402

from hil_sim.bench import journey_report, report, report_passive  # noqa: E402

FOLDER: Final = ROOT / "docs/figures"
Summary = dict[str, Any]

EPILOG: Final = """examples:
  .venv/bin/python tools/figures.py                                   # write the tables
  .venv/bin/python tools/figures.py --check                           # exit 1 when a document is out of date
  argus-sim bench journey --split judge --seeds 1 --profiles argus --out /tmp/j
  cp /tmp/j/journey.json docs/figures/ && .venv/bin/python tools/figures.py

exit codes: 0 all is well, 1 a document is out of date, 2 bad arguments or a damaged file"""


def _without_title(text: str) -> str:
    """Return a report as a part of a page that has a title of its own."""
    return re.sub(r"^# [^\n]*\n+", "", text).replace("\n## ", "\n### ").rstrip("\n")


def journey(found: Summary) -> str:
    """Return the tables of `bench journey`."""
    return _without_title(journey_report.markdown(found["rows"], found["meta"]))


def diagnosis(found: Summary) -> str:
    """Return the tables of `bench diagnosis`."""
    return _without_title(report.markdown(found))


def drive_by(found: Summary) -> str:
    """Return the tables of `bench drive-by`."""
    return report_passive.table(found).rstrip("\n")


def _share(found: Summary) -> str:
    return f"{found['hits']} of {found['of']}"


def readme(found: Summary) -> str:
    """Return what a newcomer wants to know of the journeys: one line for each condition."""
    lines = [
        "| 45 m through rooms | arrives | reference: healthy, diagnosis off | speed / reference | hits"
        " | people hit, reference | healthy sonars named, an hour |",
        "|---|---|---|---|---|---|---|",
    ]
    said = {
        "rooms": "healthy",
        "rooms+rough": "healthy, on a rough day",
        "rooms+people": "healthy, people about",
        "rooms+one": "a sonar fails on the way",
    }
    rows = {(row["row"], row["driver"]): row for row in found["rows"]}
    for name, words in said.items():
        row, ideal = rows[name, "argus"], rows.get((name, "ideal"), rows["rooms", "ideal"])
        ratio = row["over_ideal"]["ratio"]
        over = "-" if ratio is None else f"{ratio:.2f}"
        people = f"{row['people_hit']}, {ideal['people_hit']}" if "people" in name else "-"
        named = f"{row['false_names']['rate']:.0f}"
        cells = (
            words,
            _share(row["truly"]),
            _share(ideal["truly"]),
            over,
            str(row["collisions"]),
            people,
            named,
        )
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


PARTS: Final[dict[str, dict[str, tuple[str, Callable[[Summary], str]]]]] = {
    "README.md": {"journeys": ("journey.json", readme)},
    "docs/journey.md": {"journeys": ("journey.json", journey)},
    "docs/diagnosis.md": {
        "drive-by": ("drive-by.json", drive_by),
        "diagnosis": ("diagnosis.json", diagnosis),
    },
}
"""Document, part of it, the file that its figures come from and what makes a table of them."""


def load(name: str) -> Summary:
    """Return a result file."""
    path = FOLDER / name
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        sys.exit(f"{path.relative_to(ROOT)}: {error}; take it from the bench anew (--help)")
    if not isinstance(found, dict):
        sys.exit(f"{path.relative_to(ROOT)}: no result file of a bench")
    return found


def _table(file: str, make: Callable[[Summary], str]) -> str:
    """Return the table of a result file."""
    try:
        return make(load(file))
    except (KeyError, TypeError) as error:
        sys.exit(f"docs/figures/{file}: of another version of the bench ({error}); run it anew")


def filled(name: str, text: str) -> str:
    """Return the text of a document with its figures renewed."""
    for mark, (file, make) in PARTS[name].items():
        text = marked.renewed(name, text, mark, functools.partial(_table, file, make))
    return text


def main() -> int:
    """Write the documents, or with --check compare them."""
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--check", action="store_true", help="change nothing; exit 1 when out of date")
    arguments = parser.parse_args()
    return marked.update(ROOT, PARTS, filled, arguments.check, "tools/dev figures")


if __name__ == "__main__":
    sys.exit(main())
