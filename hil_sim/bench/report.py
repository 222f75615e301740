# SPDX-License-Identifier: MIT
"""What a bench leaves: diagnosis.json, diagnosis.csv, diagnosis.md and pictures."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Final

from hil_sim.bench.figures import KINDS, NOT_FOUND, OBSERVED, ROOMS, Record, summarise
from hil_sim.errors import SimError

NAME: Final = "diagnosis"
LISTED: Final = 12
_FIELDS: Final = (
    "kind",
    "sonar",
    "text",
    "onset_s",
    "end_s",
    "visible_s",
    "visible_n",
    "visible_in_time",
    "readings_in_time",
    "contradicted_in_time",
    "apart",
    "found",
    "doubted_s",
    "named",
    "named_right",
    "named_end",
    "named_end_right",
    "latency_s",
    "latency_mm",
    "latency_readings",
    "rehabilitation",
    "rehabilitated_s",
)
_MISSION: Final = ("id", "profile", "split", "world", "place", "seed", "variant")
_LAST: Final = ("collisions", "attributable", "undetected")
_AFTER: Final = ("t_s", "driving_s", "driven_mm", "reached", "stops", "verifications", "verifying_s")


def write_report(folder: Path, records: Sequence[Record], meta: Record, *, plots: bool) -> str:
    """Write all files into the folder; return the Markdown."""
    summary = {"meta": meta | {"errors": sum(r["error"] is not None for r in records)}} | summarise(records)
    text = markdown(summary) + "\n" + "\n".join(_wrong(records)) + "\n"
    try:
        (folder / f"{NAME}.json").write_text(json.dumps(summary, indent=2) + "\n", encoding="utf-8")
        (folder / f"{NAME}.csv").write_text(table(records), encoding="utf-8")
        (folder / f"{NAME}.md").write_text(text, encoding="utf-8")
        if plots:
            from hil_sim.bench.plots import draw

            draw(folder, summary, records)
    except OSError as error:
        raise SimError(f"{folder}: cannot write the report ({error.strerror}); name another --out") from error
    return text


def table(records: Iterable[Record]) -> str:
    """Return one CSV line for each fault, and one for each mission without."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([*_MISSION, "sweep", *_FIELDS, *_AFTER, "false_disables", "false_names", *_LAST])
    for record in sorted(records, key=lambda one: str(one["id"])):
        if record["error"] is not None:
            continue
        swept = " ".join(f"{name}={value:g}" for name, value in record["sonar"].items())
        for fault in record["faults"] or [{}]:
            writer.writerow(
                [
                    *(record[name] for name in _MISSION),
                    swept,
                    *(fault.get(name) for name in _FIELDS),
                    *(record[name] for name in _AFTER),
                    len(record["false_disables"]),
                    len(record["false_names"]),
                    len(record["collisions"]),
                    record["attributable"],
                    record["undetected"],
                ]
            )
    return out.getvalue()


# ---- Markdown ---------------------------------------------------------------------------------------------------


def markdown(summary: Record) -> str:
    """Return the report for people."""
    meta = summary["meta"]
    profiles: dict[str, Record] = summary["profiles"]
    lines = ["# Bench of the diagnosis", ""]
    lines += [
        f"{sum(one['missions'] for one in profiles.values())} missions, split {meta['split']}, fault manager "
        f"{meta['core'][:12]}, {meta['errors']} missions failed. Words and rules: docs/diagnosis.md.",
        "",
    ]
    for name, one in profiles.items():
        lines += [f"## {name}", "", *_profile(one), ""]
    if summary["sensitivity"]:
        lines += ["## Sensitivity", "", *_sensitivity(summary["sensitivity"]), ""]
    return "\n".join(lines).rstrip() + "\n"


def _profile(one: Record) -> list[str]:
    lines = [
        f"{one['missions']} missions, {one['clock_hours']:.1f} clock hours; "
        f"{one['not_injected']} missions ended before their fault began.",
        "",
    ]
    lines += _rows(
        ("bar", "must", "measured", "95 % bound", "cases", "verdict"),
        [
            (
                bar["name"],
                bar["bar"],
                _value(bar["value"], bar["unit"]),
                _value(bar["bound"], bar["unit"]),
                bar["cases"],
                bar["verdict"],
            )
            for bar in one["bars"]
        ],
    )
    lines += ["", *_kinds(one), "", *_confusion(one), "", *_ideal(one), "", *_other(one)]
    return lines


# ---- what could be found ------------------------------------------------------------------------------------------

_OBSERVERS: Final = ("measured", "peers", "once", "three")


def _ideal(one: Record) -> list[str]:
    return _rows(
        (
            "found in time, %",
            "cases",
            "measured",
            "by the peers alone",
            "by the truth, once in 100 h",
            "three off",
            "latency s, median / p99: measured",
            "by the truth, once in 100 h",
        ),
        [
            (
                ", ".join(kinds) + ("; rooms" if places == ROOMS else ""),
                ideal["measured"]["of"],
                *(_percent(ideal[by]["rate"]) for by in _OBSERVERS),
                _two(ideal["latency_s"], 1.0),
                _two(ideal["once_latency_s"], 1.0),
            )
            for name, (kinds, places) in OBSERVED.items()
            for ideal in [one["ideal"][name]]
        ],
    )


def _kinds(one: Record) -> list[str]:
    rows = []
    for name, row in [*one["kinds"].items(), ("in pairs", one["pairs"]), ("all", one["all"])]:
        apart = ", ".join(f"{count} {why}" for why, count in sorted(row["apart"].items())) or "0"
        low, high = row["interval"]
        rows.append(
            (
                name,
                row["judged"],
                _percent(row["rate"]) if row["judged"] else "-",
                f"{100 * low:.1f} to {100 * high:.1f}" if row["judged"] else "-",
                _percent(row["forward"]["rate"]),
                f"{row['late']} / {row['never']}",
                _percent(row["named"]["rate"]),
                _percent(row["named_end"]["rate"]),
                _two(row["latency_s"], 1.0),
                _two(row["latency_mm"], 0.001),
                apart,
            )
        )
    return _rows(
        (
            "kind",
            "judged",
            "found %",
            "95 % interval",
            "forward six %",
            "late / never",
            "named %",
            "named at its end %",
            "latency s: median / p99",
            "m driven: median / p99",
            "set apart",
        ),
        rows,
    )


def _confusion(one: Record) -> list[str]:
    matrix = one["confusion"]
    columns = [*KINDS, "none", NOT_FOUND]
    rows = [
        (
            f"**{kind}**" if kind != "none" else "**false disables**",
            *(matrix[kind].get(column, 0) or "" for column in columns),
        )
        for kind in [*KINDS, "none"]
    ]
    return _rows(("injected \\ named", *columns), rows)


def _other(one: Record) -> list[str]:
    false, hurt, named = one["false_disables"], one["false_disables_with_faults"], one["false_names"]
    verify, hits, back = one["verification"], one["collisions"], one["rehabilitation"]
    counts = ", ".join(f"{count} {how}" for how, count in sorted(back["counts"].items()))
    doubted = [_percent(one["doubted"][kinds]["rate"]) for kinds in ("sure", "hard")]
    lines = [
        f"- DISABLED or a SUSPECT with any kind, also a wrong one, in time: {doubted[0]} % (off, stuck, garbage, slow) "
        f"and {doubted[1]} % (wrong, intermittent)",
        f"- False disables, fault-free: {false['count']} in {false['hours']:.2f} h of {false['missions']} missions; "
        f"of healthy sonars in missions with faults: {hurt['count']} in {hurt['hours']:.2f} h",
        f"- A healthy sonar SUSPECT with a kind, fault-free: {named['count']} times in {named['hours']:.2f} h",
        f"- In a clock hour: {verify['stops_per_h']} stops, {verify['verifications_per_h']} verifications, "
        f"{verify['verifying_s_per_h']} s spent on them",
        f"- Repaired: {counts or 'none'}; s of driving until HEALTHY, median / p99: {_two(back['driving_s'], 1.0)}",
        f"- Missions with a collision: {hits['attributable']} attributable ({hits['undetected']} with a fault not yet "
        f"found), {hits['other']} other; {hits['struck']} times a person walked into the standing robot",
    ]
    for name, share in one["reached"].items():
        lines.append(f"- Goal reached within the limit, {name}: {share['hits']} of {share['of']}")
    return lines


def _sensitivity(points: Sequence[Record]) -> list[str]:
    return _rows(
        (
            "profile",
            "parameter",
            "value",
            "faults judged",
            "ended before",
            "found %",
            "false disables / 100 h",
            "95 % bound",
        ),
        [
            (
                p["profile"],
                p["parameter"],
                f"{p['value']:g}",
                p["judged"],
                p["not_injected"],
                _percent(p["found_all"]),
                _value(p["false_per_100h"], ""),
                _value(p["false_per_100h_high"], ""),
            )
            for p in sorted(points, key=lambda p: (p["profile"], p["parameter"], p["value"]))
        ],
    )


def _wrong(records: Sequence[Record]) -> list[str]:
    """The missions in which something went wrong, for --one; the first `LISTED` of each profile and sort."""
    lines = ["## What went wrong", ""]
    found: dict[tuple[str, str], list[str]] = {}
    for record in sorted(records, key=lambda one: str(one["id"])):
        for what in [] if record["error"] is not None else _complaints(record):
            found.setdefault((record["profile"], what), []).append(record["id"])
    for (_, what), ids in sorted(found.items()):
        lines += [f"- {what} ({len(ids)}):", *(f"  - `{name}`" for name in ids[:LISTED])]
    return lines if found else [*lines, "Nothing."]


def _complaints(record: Record) -> list[str]:
    what = [text for fault in record["faults"] for text in _fault_complaints(fault)]
    what += sorted({f"false disable as {one['kind']}" for one in record["false_disables"]})
    if record["collisions"]:
        what.append("collision due to the fault" if record["attributable"] else "collision")
    return what


def _fault_complaints(fault: Record) -> list[str]:
    what, kind = [], fault["kind"]
    if fault["apart"] is None and not fault["found"]:
        what.append(f"{kind} {'never found' if fault['latency_s'] is None else 'found late'}")
    elif fault["apart"] is None and not fault["named_right"]:
        what.append(f"{kind} named {fault['named']}")
    if fault["rehabilitation"] in ("late", "never"):
        what.append(f"{kind} repaired, HEALTHY {fault['rehabilitation']}")
    return what


def _rows(head: Sequence[str], rows: Iterable[Sequence[Any]]) -> list[str]:
    return [
        f"| {' | '.join(head)} |",
        f"|{'---|' * len(head)}",
        *(f"| {' | '.join(str(cell) for cell in row)} |" for row in rows),
    ]


def _percent(value: float | None) -> str:
    return "-" if value is None else f"{100 * value:.1f}"


def _value(value: float | None, unit: str) -> str:
    if value is None:
        return "-"
    if unit == "%":
        return f"{100 * value:.2f} %"
    if unit == "s":
        return f"{value:.3f} s"  # as fine as it is measured: 2.004 s is more than 2
    return f"{value:.2f} {unit}".rstrip() if value < 1000 else f"{value:.0f} {unit}".rstrip()


def _two(spread: Record, factor: float) -> str:
    if spread["median"] is None:
        return "-"
    return f"{factor * spread['median']:.2f} / {factor * spread['p99']:.2f}"
