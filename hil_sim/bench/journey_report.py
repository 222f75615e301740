# SPDX-License-Identifier: MIT
"""What `bench journey` leaves: journey.json, journey.csv, journey.md and pictures."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

from hil_sim.bench.journey import IDEAL, parse_row
from hil_sim.bench.journey_bars import bars, found_of_one
from hil_sim.bench.journey_figures import over_ideal, summarise
from hil_sim.errors import SimError

Record = dict[str, Any]
NAME: Final = "journey"
LISTED: Final = 12
SLOW: Final = 0.8
"""Missions below this part of the ideal's speed are listed."""
_MISSION: Final = (
    "id", "driver", "split", "row", "world", "seed", "word", "truly", "goal_mm", "odometry_off_mm", "course_mm",
    "progress_mm", "driven_mm", "t_s", "driving_s", "stops", "looks", "looking_s", "turned_deg", "energy_j",
    "closest_mm", "early_mm", "attributable", "met_ahead", "walked_into", "struck",
)  # fmt: skip
_COUNTED: Final = ("false_names", "false_disables", "collisions")


def write_report(folder: Path, records: Sequence[Record], meta: Record, *, plots: bool) -> str:
    """Write all files into the folder; return the Markdown."""
    errors = sum(record["error"] is not None for record in records)
    rows = summarise(records)
    text = markdown(rows, meta | {"errors": errors}) + "".join(f"{line}\n" for line in _listed(records))
    try:
        summary = {
            "meta": meta | {"errors": errors},
            "bars": [asdict(bar) for bar in bars(rows)],
            "rows": rows,
        }
        (folder / f"{NAME}.json").write_text(json.dumps(summary, indent=2) + "\n", encoding="utf-8")
        (folder / f"{NAME}.csv").write_text(table(records), encoding="utf-8")
        (folder / f"{NAME}.md").write_text(text, encoding="utf-8")
        if plots:
            from hil_sim.bench.journey_plots import draw

            draw(folder, records)
    except OSError as error:
        raise SimError(f"{folder}: cannot write the report ({error.strerror}); name another --out") from error
    return text


def table(records: Iterable[Record]) -> str:
    """Return one CSV line for each mission."""
    good = {record["id"]: record for record in records if record["error"] is None}
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([*_MISSION, *_COUNTED, "over_ideal", "faults"])
    for _, record in sorted(good.items()):
        ideal = good.get(record["ideal"])
        ratio = over_ideal(record, ideal) if ideal is not None else None
        writer.writerow(
            [
                *(record[name] for name in _MISSION),
                *(len(record[name]) for name in _COUNTED),
                "" if ratio is None else f"{ratio:.4f}",
                " ".join(record["faulty"]),
            ]
        )
    return out.getvalue()


# ---- Markdown ---------------------------------------------------------------------------------------------------


def markdown(rows: Sequence[Record], meta: Record) -> str:
    """Return the report for people."""
    lines = [
        "# Journeys",
        "",
        f"{sum(row['missions'] for row in rows)} missions, split {meta['split']}, fault manager {meta['core'][:12]}, "
        f"{meta['errors']} missions failed. Words and rules: docs/journey.md. Intervals are of 95 %.",
        "",
        *_bars(rows),
        *_grid(_JOURNEY, [_journey(row) for row in rows]),
        "",
        *_grid(_PRICE, [_price(row) for row in rows]),
        "",
        *_grid(("row", "driver", "share of the clock in each mode, %"), [_modes(row) for row in rows]),
        "",
        *_faults(rows),
        *(f"- `{name}`: {parse_row(name).says}" for name in dict.fromkeys(row["row"] for row in rows)),
    ]
    return "\n".join(lines) + "\n"


def _bars(rows: Sequence[Record]) -> list[str]:
    lines = [
        (
            bar.name,
            bar.bar,
            _value(bar.value, bar.unit),
            _value(bar.bound, bar.unit),
            str(bar.cases),
            bar.verdict,
        )
        for bar in bars(rows)
    ]
    return [*_grid(("bar", "must", "measured", "95 % bound", "cases", "verdict"), lines), ""] if lines else []


def _value(value: float | None, unit: str) -> str:
    if value is None:
        return "-"
    return f"{100 * value:.1f} %" if unit == "%" else f"{value:.3g} {unit}".rstrip()


_JOURNEY: Final = (
    "row", "driver", "n", "mm/s", "over ideal", "median, worst", "truly there, %", "by its word", "gave up",
    "odometry off mm", "closest mm: least, median", "collisions (attributable)", "people: met ahead, walked into",
)  # fmt: skip
_PRICE: Final = (
    "row", "driver", "clock h", "stops/h", "looks/h", "s looking/h", "deg/m", "J/m", "false names/h",
    "false disables/h", "m in 330 s: least, median",
)  # fmt: skip


def contacts(row: Record) -> str:
    """Contacts with people: met ahead, walked into. Published figures of before the split have their sum alone."""
    if "people_hit" in row:
        return f"{row['people_hit']}, not split"
    return f"{row['met_ahead']}, {row['walked_into']}"


def _journey(row: Record) -> tuple[str, ...]:
    over = row["over_ideal"]
    ratio = "-" if over["ratio"] is None else f"{over['ratio']:.2f} ({over['low']:.2f} to {over['high']:.2f})"
    return (
        row["row"],
        row["driver"],
        str(row["missions"]),
        _number(row["speed_mm_s"], 0),
        ratio,
        f"{_number(over['median'], 2)}, {_number(over['worst'], 2)} of {over['n']}",
        _percent(row["truly"]),
        f"{row['word']['hits']}",
        f"{row['gave_up']['hits']}" + (f" in {row['gave_up_s']:.0f} s" if row["gave_up"]["hits"] else ""),
        _number(row["odometry_off_mm"], 0),
        f"{_number(row['closest_mm']['least'], 0)}, {_number(row['closest_mm']['median'], 0)}",
        f"{row['collisions']} ({row['attributable']})",
        contacts(row),
    )


def _price(row: Record) -> tuple[str, ...]:
    early = row["early_mm"]
    return (
        row["row"],
        row["driver"],
        f"{row['clock_hours']:.2f}",
        _number(row["stops"]["rate"], 0),
        _number(row["looks"]["rate"], 0),
        _number(row["looking_s_per_hour"], 0),
        _number(row["turned_deg_per_m"], 0),
        _number(row["energy_j_per_m"], 0),
        _per_hour(row["false_names"]),
        _per_hour(row["false_disables"]),
        f"{_number(early['least'], -3)}, {_number(early['median'], -3)}",
    )


def _modes(row: Record) -> tuple[str, ...]:
    shares = ", ".join(f"{name} {100 * part:.0f}" for name, part in row["modes"].items() if part >= 0.005)
    return row["row"], row["driver"], shares


def _faults(rows: Sequence[Record]) -> list[str]:
    """What was found of the faults in time and ever: by row, and by kind where one fails alone."""
    lines = [(row["row"], row["driver"], "all", row["found"]["all"]) for row in rows if "all" in row["found"]]
    for driver in dict.fromkeys(row["driver"] for row in rows):
        kinds = found_of_one(row for row in rows if row["driver"] == driver)
        lines += [("one fault", driver, kind, found) for kind, found in kinds.items()]
    if not lines:
        return []
    head = ("row", "driver", "faults", "n", "found in time, %", "ever, %")
    return [*_grid(head, [_fault(*line) for line in lines]), ""]


def _fault(row: str, driver: str, kind: str, found: Record) -> tuple[str, ...]:
    return row, driver, kind, str(found["ever"]["of"]), _percent(found["in_time"]), _percent(found["ever"])


def _listed(records: Sequence[Record]) -> list[str]:
    """The missions that are worth a look with --one, worst first."""
    good = {record["id"]: record for record in records if record["error"] is None}
    driven = [record for record in good.values() if record["driver"] != IDEAL]
    hits = [(record["id"], "") for record in driven if record["attributable"]]
    return [
        *_list("Attributable collisions", hits),
        *_list("By their word, but not truly there", _mistaken(driven)),
        *_list("Slowest against their ideal", _slowest(driven, good)),
    ]


def _list(title: str, shown: Sequence[tuple[str, str]]) -> list[str]:
    if not shown:
        return []
    lines = [f"- `{name}` {said}".rstrip() for name, said in shown[:LISTED]]
    return ["", f"{title} ({len(shown)}):", "", *lines]


def _mistaken(driven: Sequence[Record]) -> list[tuple[str, str]]:
    wrong = [record for record in driven if record["word"] == "reached" and not record["truly"]]
    return [(record["id"], f"{record['goal_mm']:.0f} mm off") for record in wrong]


def _slowest(driven: Sequence[Record], good: Mapping[str, Record]) -> list[tuple[str, str]]:
    ratios = [
        (ratio, record["id"], f"{ratio:.2f}, {record['word']} after {record['t_s']:.0f} s")
        for record in driven
        if record["ideal"] in good and (ratio := over_ideal(record, good[record["ideal"]])) is not None
    ]
    return [(name, said) for ratio, name, said in sorted(ratios) if ratio < SLOW]


def _grid(head: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    return [
        f"| {' | '.join(head)} |",
        "|" + "---|" * len(head),
        *(f"| {' | '.join(row)} |" for row in rows),
    ]


def _number(value: float | None, digits: int) -> str:
    """Digits after the point; -3 gives metres of mm, with one."""
    if value is None:
        return "-"
    return f"{value / 1000:.1f}" if digits < 0 else f"{value:.{digits}f}"


def _percent(part: Record) -> str:
    if not part["of"]:
        return "-"
    return f"{100 * part['share']:.0f} ({100 * part['low']:.0f} to {100 * part['high']:.0f})"


def _per_hour(found: Record) -> str:
    if found["rate"] is None:
        return "-"
    return f"{found['rate']:.1f} ({found['low']:.1f} to {found['high']:.1f})"
