# SPDX-License-Identifier: MIT
"""The figures of drive-bys: found in time and ever, by kind, and what was said wrongly in a clock hour."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from hil_sim.bench.judge import BOUND_S
from hil_sim.bench.passive import Finding, Verdict
from hil_sim.bench.stats import quantile, rate, share


def _found(findings: Sequence[Finding]) -> dict[str, Any]:
    seconds = [f.latency_s for f in findings if f.latency_s is not None]
    return {
        "in_time": share(sum(f.in_time for f in findings), len(findings)),
        "ever": share(len(seconds), len(findings)),
        "named_right": share(sum(f.named_right for f in findings), len(seconds)),
        "median_s": quantile(seconds, 0.5),
        "p99_s": quantile(seconds, 0.99),
    }


def _false(verdicts: Sequence[Verdict]) -> dict[str, Any]:
    hours = sum(verdict.hours for verdict in verdicts)
    return {
        "names": rate(sum(len(verdict.names) for verdict in verdicts), hours),
        "disables": rate(sum(len(verdict.disables) for verdict in verdicts), hours),
    }


def summarise(verdicts: Sequence[Verdict]) -> dict[str, Any]:
    """Return the figures of some verdicts, as they go into JSON."""
    return {
        "streams": len(verdicts),
        "found": {name: _found(group) for name, group in _groups(verdicts).items() if group},
        "false": {
            "nobody about": _false([verdict for verdict in verdicts if not verdict.people]),
            "people": _false([verdict for verdict in verdicts if verdict.people]),
        },
    }


def _groups(verdicts: Sequence[Verdict]) -> dict[str, list[Finding]]:
    findings = [finding for verdict in verdicts for finding in verdict.findings]
    groups = {"all": findings, "rooms": [f for f in findings if f.place == "room"]}
    return groups | {kind: [f for f in findings if f.kind == kind] for kind in BOUND_S}


def _percent(part: dict[str, Any]) -> str:
    if not part["of"]:
        return "-"
    return f"{100 * part['share']:.1f} ({100 * part['low']:.1f} to {100 * part['high']:.1f})"


def _seconds(value: float | None) -> str:
    return "-" if value is None else f"{value:.1f}"


def _per_hour(found: dict[str, Any]) -> str:
    if found["rate"] is None:
        return "-"
    return f"{found['rate']:.2f} ({found['low']:.2f} to {found['high']:.2f})"


def table(figures: dict[str, Any]) -> str:
    """Return the figures as two tables; intervals are of 95 %."""
    lines = [
        "| faults | n | in time, % | ever, % | named right, % | median / p99, s |",
        "|---|---|---|---|---|---|",
    ]
    for name, row in figures["found"].items():
        lines.append(
            f"| {name} | {row['in_time']['of']} | {_percent(row['in_time'])} | {_percent(row['ever'])} "
            f"| {_percent(row['named_right'])} | {_seconds(row['median_s'])} / {_seconds(row['p99_s'])} |"
        )
    lines += ["", "| in a clock hour | h | false names | false disables |", "|---|---|---|---|"]
    for name, row in figures["false"].items():
        lines.append(
            f"| {name} | {row['names']['hours']:.2f} | {_per_hour(row['names'])} | {_per_hour(row['disables'])} |"
        )
    return "\n".join(lines) + "\n"
