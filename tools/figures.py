#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Write the measured figures into the documents, from the result files in docs/figures.

A bench leaves its figures as JSON. The file that is published lies in docs/figures, and every table of the
documents is made of it. To publish a new run, copy its JSON there and run this tool. What a program prints without
leaving a file is entered in docs/figures/measured.json by hand, with the command and the day. Three pictures are drawn
of the files, too; each holds a digest of what it shows.
"""

from __future__ import annotations

import argparse
import functools
import hashlib
import json
import re
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Final

ROOT: Final = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))
sys.path.insert(0, str(ROOT / "tools"))

import marked  # noqa: E402
from PIL import Image  # noqa: E402

from hil_sim.bench import journey_report, overview, report, report_passive  # noqa: E402

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
    """Return the tables of `bench drive-by`, after a line that says of which build and how many drives they are."""
    build = f"fault manager {found['core'][:12]}" if "core" in found else "fault manager not noted"
    about = f"{found['streams']} recorded drives, split {found['split']}, {build}."
    return f"{about}\n\n{report_passive.table(found)}".rstrip("\n")


def _grid(columns: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a Markdown table."""
    lines = [columns, ["---"] * len(columns), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def measured(name: str, found: Summary) -> str:
    """Return a table of figures that were entered by hand, after a line that says how and when they came about."""
    entry = found[name]
    command = f" by `{entry['command']}`" if "command" in entry else ""
    host = f" ({entry['host']})" if "host" in entry else ""
    if any(len(row) != len(entry["columns"]) for row in entry["rows"]):
        raise KeyError(f"{name}: a row has not as many cells as there are columns")
    return f"Measured on {entry['date']}{command}{host}:\n\n{_grid(entry['columns'], entry['rows'])}"


def performance(found: Summary) -> str:
    """Return the table of `bench performance`, after a line that says how and when it came about."""
    origin = f"Measured on {found['date']} by `{found['command']}` ({found['host']}):"
    rows = [(row["what"], row["text"], row["of"]) for row in found["rows"]]
    return f"{origin}\n\n{_grid(('what', 'median (least to greatest)', 'unit'), rows)}"


def _counts(ends: dict[str, int]) -> tuple[str, str]:
    """Return how many drives ended right, and what became of the others."""
    others = ", ".join(f"{n} {word}" for word, n in sorted(ends.items()) if word != "yes")
    return f"{ends.get('yes', 0)} of {sum(ends.values())}", others or "-"


def pairs_argus(found: Summary) -> str:
    """Return what profile `argus` makes of the demo's pairs of faults."""
    rows = []
    for day, words in (("plain", ""), ("rough", ", on a rough day")):
        for key, what in (
            ("demo_pair", "the pair of the demo, one drive for each seed"),
            ("pairs", "all pairs, seed 1"),
        ):
            rows.append((f"{what}{words}", *_counts(found["argus"][day][key])))
    return f"{_pairs_origin(found)}\n\n{_grid(('drives', 'end right', 'others'), rows)}"


def pairs_paper(found: Summary) -> str:
    """Return what profile `paper` makes of each pair."""
    sonars = list(found["paper"])
    rows = [[dead, *(found["paper"][dead].get(liar, "") for liar in sonars)] for dead in sonars]
    return f"{_pairs_origin(found)}\n\n{_grid(['off A', *(f'B = {liar}' for liar in sonars)], rows)}"


def pairs_told(found: Summary) -> str:
    """Return in a sentence how many pairs profile `paper` tells."""
    cells = [cell for row in found["paper"].values() for cell in row.values()]
    return (
        f"Of the {len(cells)} pairs (sonar A dead, later sonar B reads half the truth) in that world `paper` tells "
        f"{cells.count('yes')} right with every seed ([demo](demo.md#what-each-profile-can-tell))."
    )


def _pairs_origin(found: Summary) -> str:
    meta = found["meta"]
    return f"Measured on {meta['date']} by `tools/dev bench pairs`, fault manager {meta['core'][:12]}:"


def _share(found: Summary) -> str:
    return f"{found['hits']} of {found['of']}"


def _contacts(row: Summary) -> str:
    return journey_report.contacts(row).removesuffix(", not split")


def readme(found: Summary) -> str:
    """Return what a newcomer wants to know of the journeys: one line for each condition."""
    lines = [
        "| 45 m through rooms | arrives | reference: same course, healthy, diagnosis off | speed / reference"
        " | things hit | people hit: Argus, reference | false alarms an hour |",
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
        people = f"{_contacts(row)}; {_contacts(ideal)}" if "people" in name else "-"
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
    "docs/demo.md": {"pairs": ("pairs.json", pairs_argus), "paper-pairs": ("pairs.json", pairs_paper)},
    "docs/paper-profile.md": {"pairs": ("pairs.json", pairs_told)},
    "docs/guardian.md": {"measured": ("measured.json", functools.partial(measured, "guardian"))},
    "docs/monitor.md": {"measured": ("measured.json", functools.partial(measured, "monitor"))},
    "docs/performance.md": {"performance": ("performance.json", performance)},
    "docs/peers.md": {"measured": ("measured.json", functools.partial(measured, "peers"))},
}
"""Document, part of it, the file that its figures come from and what makes a table of them."""

PICTURES: Final[dict[str, tuple[tuple[str, ...], Callable[..., None]]]] = {
    "docs/img/journey.png": (("journey.json",), overview.draw_journeys),
    "docs/img/performance.png": (("performance.json",), overview.draw_speeds),
    "docs/img/diagnosis.png": (("drive-by.json", "diagnosis.json"), overview.draw_found),
}
"""Picture, the files whose figures it shows and what draws it."""


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


def _digest(files: Sequence[str]) -> str:
    """Return what stands for the contents of result files."""
    return hashlib.sha256(b"".join((FOLDER / name).read_bytes() for name in files)).hexdigest()


def is_current(path: Path, files: Sequence[str]) -> bool:
    """Return whether a picture shows the figures of these files, by the digest that it holds."""
    if not path.is_file():
        return False
    with Image.open(path) as image:
        return bool(image.info.get("Source") == _digest(files))


def draw_pictures(check: bool) -> int:
    """Draw the pictures whose figures have changed; with `check` return 1 if there is one."""
    stale = [name for name, (files, _) in PICTURES.items() if not is_current(ROOT / name, files)]
    for name in stale if not check else ():
        files, draw = PICTURES[name]
        draw(ROOT / name, _digest(files), *map(load, files))
    if check and stale:
        print(f"{', '.join(stale)}: out of date, run tools/dev figures", file=sys.stderr)
    return int(check and bool(stale))


def main() -> int:
    """Write the documents, or with --check compare them."""
    parser = argparse.ArgumentParser(
        description=__doc__, epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--check", action="store_true", help="change nothing; exit 1 when out of date")
    arguments = parser.parse_args()
    documents = marked.update(ROOT, PARTS, filled, arguments.check, "tools/dev figures")
    return max(documents, draw_pictures(arguments.check))


if __name__ == "__main__":
    sys.exit(main())
