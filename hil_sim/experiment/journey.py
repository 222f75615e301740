# SPDX-License-Identifier: MIT
"""`argus-sim experiment journey`: the study of journeys, resumable, and what comes of its results."""

from __future__ import annotations

import argparse
import csv
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from hil_sim.bench import pool
from hil_sim.bench.arguments import EXIT_FAILED, EXIT_INTERRUPTED, say
from hil_sim.bench.runner import fixed_core, keep
from hil_sim.bench.store import RESULTS, Store
from hil_sim.errors import SimError
from hil_sim.experiment.cases import Case, make_cases, parse_dead, parse_id
from hil_sim.experiment.drive import RECORD_FORMAT, Record, failed, run_case, work

COLUMNS: Final = (
    "policy", "world", "seed", "dead", "day", "word", "truly", "course_mm", "t_s", "goal_mm", "driven_mm",
    "turned_deg", "stops", "looking_s", "closest_mm", "collisions", "idle_s", "sonar_s", "wheel_m", "accel_j",
    "s1", "s4", "s5", "s7",
)  # fmt: skip
TABLE: Final = "journey.csv"
_TEXT: Final = ("policy", "world", "dead", "day", "word")


def cases_of(arguments: argparse.Namespace) -> list[Case]:
    """Return the cases that the arguments ask for."""
    return make_cases(
        arguments.policies, arguments.worlds, arguments.seeds, parse_dead(arguments.masks), day=arguments.day
    )


def run_study(arguments: argparse.Namespace, out: Path) -> tuple[int, list[Record]]:
    """Drive what has no result yet; return the exit code and all records that are there."""
    cases = cases_of(arguments)
    with fixed_core() as digest:
        meta = {"core": digest, "format": RECORD_FORMAT, "split": "judge"}
        with Store(out, meta, resume=arguments.resume, fresh=arguments.fresh) as store:
            todo = [case.id for case in cases if not store.done(case.id)]
            records = pool.run_here(todo, min(arguments.jobs, max(len(todo), 1)), work, failed)
            if not keep(records, store, len(cases), len(todo)):
                say(f"interrupted; {len(store.records)} journeys are in {out / RESULTS}, --resume goes on")
                return EXIT_INTERRUPTED, []
            found = list(store.records.values())
    wrong = [record for record in found if record["error"] is not None]
    for record in wrong[:5]:
        say(f"{record['id']}: {record['error']}")
    write_table(out / TABLE, [record for record in found if record["error"] is None])
    return EXIT_FAILED if wrong else 0, found


def write_table(path: Path, records: Sequence[Record]) -> None:
    """Write records as a table, one line each, in an order that the run does not change."""
    rows = sorted(records, key=lambda record: [str(record[name]) for name in ("policy", "day", "dead", "world", "seed")])
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for record in rows:
            writer.writerow(["" if record[name] is None else _cell(record[name]) for name in COLUMNS])


def _cell(value: Any) -> Any:
    return int(value) if isinstance(value, bool) else value


def read_table(path: Path) -> list[Record]:
    """Return the records of a table; SimError when it is none."""
    try:
        with path.open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
    except OSError as error:
        raise SimError(f"{path}: cannot read it ({error.strerror}); name a {TABLE} of this study") from error
    if not rows or tuple(rows[0]) != COLUMNS:
        raise SimError(f"{path}: is no table of journeys; name a {TABLE} of this study")
    try:
        return [{name: _value(name, text) for name, text in row.items()} for row in rows]
    except (TypeError, ValueError):
        raise SimError(f"{path}: a line is damaged; make it anew with --out DIR --resume") from None


def _value(name: str, text: str) -> Any:
    if name in _TEXT:
        return text
    if name == "truly":
        return text == "1"
    return None if text == "" else float(text) if "." in text else int(text)


def show_one(text: str) -> str:
    """Run one journey and return its record and what broke a rule."""
    record, _, diary = run_case(parse_id(text))
    lines = [json.dumps(record)]
    lines += [f"{b.rule} at {b.t_s:.2f} s, {b.x_mm:.0f},{b.y_mm:.0f}: {b.says}" for b in diary.safety.breaches]
    return "\n".join(lines) + "\n"
