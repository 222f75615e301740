# SPDX-License-Identifier: MIT
"""What the journeys of the study amount to: figures, tables and bars from its records."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import mean, median
from typing import Any, Final

from hil_sim.experiment.cases import ARRAYS, HEALTHY, POLICIES, count_dead
from hil_sim.tables import load

Record = dict[str, Any]
IDLE_FACTORS: Final = (0.5, 1.0, 2.0)
PAPER: Final = "paper"
OURS: Final = "adaptive"
RULES: Final = ("s1", "s4", "s5", "s7")
GROUPS: Final = (HEALTHY, "1", "2", "3", "4", "5", "6", *ARRAYS)
_POWER: Final[Mapping[str, float]] = load("energy")["power"]


def group_of(dead: str) -> str:
    """Return where a set of dead sonars is counted: by how many there are, or as an array."""
    count = count_dead(dead)
    return dead if count is None or count == 0 else str(count)


def energy_j(record: Record, idle: float = 1.0) -> float:
    """Return the energy of a journey, with so much of the idle power."""
    return float(
        record["idle_s"] * _POWER["idle_w"] * idle
        + record["sonar_s"] * _POWER["sonar_w"]
        + record["wheel_m"] * _POWER["wheel_j_per_m"]
        + record["accel_j"]
    )


def run_of(record: Record) -> tuple[Any, ...]:
    """Return what two policies have in common that drive the same run."""
    return record["world"], record["seed"], record["dead"], record["day"]


def arrived(record: Record) -> bool:
    """Whether the robot says that it is at its goal, and truly is."""
    return record["word"] == "reached" and bool(record["truly"])


@dataclass(frozen=True)
class Ratio:
    """A quantity of one policy over that of another, on the runs that both end at the goal: the mean of the sets."""

    mean: float | None
    worst: float | None
    sets: int
    runs: int


def ratio(records: Iterable[Record], of: str, over: str, quantity: Callable[[Record], float]) -> Ratio:
    """Compare two policies on the 62 sets of dead sonars that are neither empty nor whole, on a plain day."""
    own: dict[tuple[Any, ...], dict[str, Record]] = {}
    for record in records:
        if (
            record["policy"] in (of, over)
            and group_of(record["dead"]) in "12345"
            and record["day"] == "plain"
        ):
            own.setdefault(run_of(record), {})[record["policy"]] = record
    sums: dict[str, list[float]] = {}
    runs = 0
    for (_, _, dead, _), pair in own.items():
        if len(pair) == 2 and all(map(arrived, pair.values())):
            runs += 1
            total = sums.setdefault(dead, [0.0, 0.0])
            total[0] += quantity(pair[of])
            total[1] += quantity(pair[over])
    ratios = [a / b for a, b in sums.values() if b > 0]
    return Ratio(mean(ratios) if ratios else None, max(ratios, default=None), len(ratios), runs)


def over_healthy(records: Iterable[Record], policy: str) -> Ratio:
    """Compare the journeys with one dead sonar to those of the healthy robot in the same world, seed by seed."""
    plain = [r for r in records if r["policy"] == policy and r["day"] == "plain" and arrived(r)]
    healthy = {(r["world"], r["seed"]): r["t_s"] for r in plain if r["dead"] == HEALTHY}
    sums: dict[str, list[float]] = {}
    runs = 0
    for record in plain:
        key = record["world"], record["seed"]
        if group_of(record["dead"]) == "1" and key in healthy:
            runs += 1
            total = sums.setdefault(record["dead"], [0.0, 0.0])
            total[0] += record["t_s"]
            total[1] += healthy[key]
    ratios = [a / b for a, b in sums.values()]
    return Ratio(mean(ratios) if ratios else None, max(ratios, default=None), len(ratios), runs)


# ---- tables ----------------------------------------------------------------------------------------------------


def _goals(records: Sequence[Record]) -> str:
    return f"{sum(map(arrived, records))}/{len(records)}" if records else "-"


def _middle(values: Sequence[float], form: str = "{:.0f}") -> str:
    return form.format(median(values)) if values else "-"


def goals_table(records: Sequence[Record]) -> str:
    """Return the goals reached by policy and number of dead sonars, in Markdown."""
    plain = [r for r in records if r["day"] == "plain"]
    names = [name for name in POLICIES if any(r["policy"] == name for r in plain)]
    groups = [g for g in GROUPS if any(group_of(r["dead"]) == g for r in plain)]
    lines = [f"| policy | {' | '.join(groups)} |", "|---|" + "---|" * len(groups)]
    for name in names:
        own = [[r for r in plain if r["policy"] == name and group_of(r["dead"]) == g] for g in groups]
        lines.append(f"| `{name}` | {' | '.join(map(_goals, own))} |")
    return "\n".join(lines) + "\n"


def price_table(records: Sequence[Record]) -> str:
    """Return medians over the journeys that end at the goal, by policy and number of dead sonars, in Markdown."""
    plain = [r for r in records if r["day"] == "plain"]
    lines = [
        "| policy | dead | journeys | s | J | stops | degrees | closest, mm (least) |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for name in POLICIES:
        for group in GROUPS:
            own = [r for r in plain if r["policy"] == name and group_of(r["dead"]) == group and arrived(r)]
            if own:
                near = [r["closest_mm"] for r in own if r["closest_mm"] is not None]
                cells = [
                    _middle([r["t_s"] for r in own]),
                    _middle([energy_j(r) for r in own]),
                    _middle([r["stops"] for r in own]),
                    _middle([r["turned_deg"] for r in own]),
                    f"{_middle(near)} ({min(near):.0f})" if near else "-",
                ]
                lines.append(f"| `{name}` | {group} | {len(own)} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def safety_table(records: Sequence[Record]) -> str:
    """Return collisions and broken rules by policy, in Markdown: journeys in which there was one."""
    head = " | ".join(rule.upper() for rule in RULES)
    lines = [
        f"| policy | journeys | hours | collisions | {head} | closest, mm |",
        "|---|---|---|---|" + "---|" * (len(RULES) + 1),
    ]
    for name in POLICIES:
        own = [r for r in records if r["policy"] == name]
        if own:
            hours = sum(r["t_s"] for r in own) / 3600
            near = [r["closest_mm"] for r in own if r["closest_mm"] is not None]
            broken = " | ".join(str(sum(r[rule] > 0 for r in own)) for rule in RULES)
            least = f"{min(near):.0f}" if near else "-"
            hits = sum(r["collisions"] for r in own)
            lines.append(f"| `{name}` | {len(own)} | {hours:.1f} | {hits} | {broken} | {least} |")
    return "\n".join(lines) + "\n"


def _ratio_cell(found: Ratio) -> str:
    if found.mean is None:
        return "-"
    return f"{found.mean:.2f} (worst set {found.worst:.2f}; {found.sets} sets, {found.runs} runs)"


def bars_table(records: Sequence[Record]) -> str:
    """Return what was asked for beside what was measured, in Markdown."""
    ours = [r for r in records if r["policy"] == OURS]
    plain = [r for r in ours if r["day"] == "plain"]
    some = [r for r in plain if group_of(r["dead"]) in "12345"]
    front = [r for r in plain if r["dead"] in ("front", "1+2+3+4+5+6")]
    rough = [r for r in ours if r["day"] != "plain"]
    rows: list[tuple[str, str, str]] = [
        ("goals reached, 1 to 5 of six dead", ">= 99 %", _share(some)),
        ("goals reached, front six or front array lost, rear healthy", ">= 95 %", _share(front)),
        (
            "time over `paper`, same run",
            "<= 0.4",
            _ratio_cell(ratio(records, OURS, PAPER, lambda r: float(r["t_s"]))),
        ),
    ]
    for factor in IDLE_FACTORS:
        found = ratio(records, OURS, PAPER, lambda r, f=factor: energy_j(r, f))  # type: ignore[misc]
        rows.append((f"energy over `paper`, P_idle x {factor:g}", "<= 0.6", _ratio_cell(found)))
    rows += [
        ("time with one dead over the healthy journey", "<= 1.3", _ratio_cell(over_healthy(records, OURS))),
        (
            "collisions, all policies",
            "0",
            f"{sum(r['collisions'] for r in records)} in {len(records)} journeys",
        ),
        ("goals reached on a rough day", ">= 97 %", _share(rough)),
    ]
    lines = ["| | asked for | measured |", "|---|---|---|"]
    return "\n".join([*lines, *(f"| {a} | {b} | {c} |" for a, b, c in rows)]) + "\n"


def _share(records: Sequence[Record]) -> str:
    if not records:
        return "not run"
    truly, word = sum(map(arrived, records)), sum(r["word"] == "reached" for r in records)
    extra = f"; by its own word {word}" if word != truly else ""
    return f"{truly} of {len(records)}, {100 * truly / len(records):.1f} %{extra}"


def coverage(records: Sequence[Record]) -> str:
    """Say in Markdown which part of the whole study the records are."""
    lines = [
        "| policy | day | sets of dead sonars | worlds | seeds | journeys |",
        "|---|---|---|---|---|---|",
    ]
    for name in POLICIES:
        for day in sorted({r["day"] for r in records}):
            own = [r for r in records if r["policy"] == name and r["day"] == day]
            if own:
                seeds = sorted({r["seed"] for r in own})
                worlds = ", ".join(sorted({r["world"] for r in own}))
                sets = len({r["dead"] for r in own})
                lines.append(
                    f"| `{name}` | {day} | {sets} of 66 | {worlds} | {', '.join(map(str, seeds))} | {len(own)} |"
                )
    return "\n".join(lines) + "\n"
