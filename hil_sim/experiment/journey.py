# SPDX-License-Identifier: MIT
"""`argus-sim experiment journey`: the study of journeys, resumable, and what comes of its results."""

from __future__ import annotations

import argparse
import csv
import gzip
import json
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

from hil_sim.bench import pool
from hil_sim.bench.arguments import EXIT_FAILED
from hil_sim.bench.runner import fixed_core, keep
from hil_sim.bench.store import RESULTS, Store
from hil_sim.errors import SimError
from hil_sim.experiment.cases import SPLIT, make_cases, parse_id
from hil_sim.experiment.drive import RECORD_FORMAT, Record, failed, run_case, work
from hil_sim.start import EXIT_INTERRUPTED

COLUMNS: Final = (
    "policy", "world", "seed", "dead", "day", "word", "truly", "course_mm", "t_s", "goal_mm", "driven_mm",
    "turned_deg", "stops", "looking_s", "closest_mm", "collisions", "idle_s", "sonar_s", "wheel_m", "accel_j",
    "s1", "s4", "s5", "s7",
)  # fmt: skip
TABLE: Final = "journeys.csv"
_TEXT: Final = ("policy", "world", "dead", "day", "word")


class Interrupted(SimError):
    """The study was broken off; what is done is kept."""

    exit_code = EXIT_INTERRUPTED


class NotAll(SimError):
    """Journeys failed to run."""

    exit_code = EXIT_FAILED


def run_study(arguments: argparse.Namespace) -> list[Record]:
    """Drive what has no result yet in --out; return all records that are there.

    Interrupted when it was broken off, NotAll when a journey failed to run.
    """
    out = arguments.out
    cases = make_cases(
        arguments.policies, arguments.worlds, arguments.seeds, arguments.masks, day=arguments.day
    )
    with fixed_core() as digest:
        meta = {"core": digest, "format": RECORD_FORMAT, "split": SPLIT}
        with Store(out, meta, resume=arguments.resume, fresh=arguments.fresh) as store:
            todo = [case.id for case in cases if not store.done(case.id)]
            records = pool.run_here(todo, min(arguments.jobs, max(len(todo), 1)), work, failed)
            if not keep(records, store, len(cases), len(todo)):
                raise Interrupted(
                    f"interrupted; {len(store.records)} journeys are in {out / RESULTS}, --resume goes on"
                )
            found = list(store.records.values())
    good = [record for record in found if record["error"] is None]
    write_table(out / TABLE, good)
    wrong = [record for record in found if record["error"] is not None]
    if wrong:
        first = f"{wrong[0]['id']}: {wrong[0]['error']}"
        raise NotAll(f"{len(wrong)} journeys failed to run, the first is {first}; --resume runs them again")
    return good


def write_table(path: Path, records: Sequence[Record]) -> None:
    """Write records as a table, one line each, in an order that the run does not change."""
    rows = sorted(
        records, key=lambda record: [str(record[name]) for name in ("policy", "day", "dead", "world", "seed")]
    )
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for record in rows:
            writer.writerow(["" if record[name] is None else _cell(record[name]) for name in COLUMNS])


def _cell(value: Any) -> Any:
    return int(value) if isinstance(value, bool) else value


def read_table(path: Path) -> list[Record]:
    """Return the records of a table, compressed by gzip or not; SimError when it is none."""
    try:
        with (
            gzip.open(path, "rt", encoding="utf-8", newline="")
            if path.suffix == ".gz"
            else path.open(encoding="utf-8", newline="") as file
        ):
            rows = list(csv.DictReader(file))
    except (gzip.BadGzipFile, EOFError, zlib.error):
        raise SimError(f"{path}: the archive is damaged; name a {TABLE} of this study") from None
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
    lines += [
        f"{b.rule} at {b.t_s:.2f} s, {b.x_mm:.0f},{b.y_mm:.0f}: {b.says}" for b in diary.safety.breaches
    ]
    return "\n".join(lines) + "\n"
