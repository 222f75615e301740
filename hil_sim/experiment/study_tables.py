# SPDX-License-Identifier: MIT
"""The tables of the study of journeys, in Markdown."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from statistics import median
from typing import Any, Final

from hil_sim.experiment.cases import POLICIES
from hil_sim.experiment.study import (
    GROUPS,
    SOME,
    Ratio,
    Record,
    arrived,
    at_goal,
    energy_j,
    group_of,
    over_healthy,
    plain,
    ratio,
)

IDLE_FACTORS: Final = (0.5, 1.0, 2.0)
PAPER: Final = "paper"
OURS: Final = "adaptive"
RULES: Final = ("s1", "s4", "s5", "s7")
FRONT_LOST: Final = ("front", "1+2+3+4+5+6")


def table(head: Sequence[str], rows: Sequence[Sequence[Any]]) -> str:
    """Return a table."""
    lines = [head, ["---"] * len(head), *rows]
    return "".join(
        f"|{'|'.join(cells)}|\n" if cells[0] == "---" else f"| {' | '.join(map(str, cells))} |\n"
        for cells in lines
    )


def _by_policy(records: Sequence[Record]) -> Iterator[tuple[str, list[Record]]]:
    for name in POLICIES:
        own = [record for record in records if record["policy"] == name]
        if own:
            yield name, own


def _in_group(records: Sequence[Record], group: str) -> list[Record]:
    return [record for record in records if group_of(record["dead"]) == group]


def _middle(values: Sequence[float]) -> str:
    return f"{median(values):.0f}" if values else "-"


def _closest(records: Sequence[Record]) -> list[float]:
    return [record["closest_mm"] for record in records if record["closest_mm"] is not None]


def coverage(records: Sequence[Record]) -> str:
    """Say which part of the whole study the records are."""
    rows = []
    for name, all_days in _by_policy(records):
        for day in sorted({record["day"] for record in all_days}):
            own = [record for record in all_days if record["day"] == day]
            seeds, worlds, sets = (sorted({r[key] for r in own}) for key in ("seed", "world", "dead"))
            parts = f"{len(sets)} of 66", ", ".join(worlds), ", ".join(map(str, seeds)), len(own)
            rows.append((f"`{name}`", day, *parts))
    return table(("policy", "day", "sets of dead sonars", "worlds", "seeds", "journeys"), rows)


def goals(records: Sequence[Record]) -> str:
    """Tell the goals reached by policy and number of dead sonars."""
    known = plain(records)
    groups = [group for group in GROUPS if _in_group(known, group)]
    rows = [
        (f"`{name}`", *(_goals(_in_group(own, group)) for group in groups)) for name, own in _by_policy(known)
    ]
    return table(("policy", *groups), rows)


def _goals(records: Sequence[Record]) -> str:
    return f"{sum(map(arrived, records))}/{len(records)}" if records else "-"


def prices(records: Sequence[Record]) -> str:
    """Tell the medians over the journeys that end at the goal, by policy and number of dead sonars."""
    rows = []
    for name, own in _by_policy(at_goal(records)):
        for group in GROUPS:
            some = _in_group(own, group)
            if some:
                near = _closest(some)
                what = [[r["t_s"] for r in some], [energy_j(r) for r in some]]
                what += [[r[key] for r in some] for key in ("stops", "turned_deg")]
                closest = f"{_middle(near)} ({min(near):.0f})" if near else "-"
                rows.append((f"`{name}`", group, len(some), *map(_middle, what), closest))
    return table(("policy", "dead", "journeys", "s", "J", "stops", "degrees", "closest, mm (least)"), rows)


def safety(records: Sequence[Record]) -> str:
    """Tell collisions and broken rules by policy: journeys in which there was one."""
    rows = []
    for name, own in _by_policy(records):
        hours = sum(record["t_s"] for record in own) / 3600
        broken = [sum(record[rule] > 0 for record in own) for rule in RULES]
        hits = sum(record["collisions"] for record in own)
        least = f"{min(_closest(own), default=0):.0f}"
        rows.append((f"`{name}`", len(own), f"{hours:.1f}", hits, *broken, least))
    head = ("policy", "journeys", "hours", "collisions", *map(str.upper, RULES), "closest, mm")
    return table(head, rows)


# ---- what was asked for ------------------------------------------------------------------------------------------


def bars(records: Sequence[Record]) -> str:
    """Tell what was asked for beside what was measured."""
    ours = [record for record in records if record["policy"] == OURS]
    known = plain(ours)
    some = [record for record in known if group_of(record["dead"]) in SOME]
    front = [record for record in known if record["dead"] in FRONT_LOST]
    hits = sum(record["collisions"] for record in records)
    rows = [
        ("goals reached, 1 to 5 of six dead", ">= 99 %", _share(some)),
        ("goals reached, front six or front array lost, rear healthy", ">= 95 %", _share(front)),
        *_against_paper(records),
        ("time with one dead over the healthy journey", "<= 1.3", _cell(over_healthy(records, OURS))),
        ("collisions, all policies", "0", f"{hits} in {len(records)} journeys"),
        ("goals reached on a rough day", ">= 97 %", _share([r for r in ours if r["day"] != "plain"])),
    ]
    return table(("", "asked for", "measured"), rows)


def _against_paper(records: Sequence[Record]) -> Iterator[tuple[str, str, str]]:
    yield "time over `paper`, same run", "<= 0.4", _cell(ratio(records, OURS, PAPER, _time_s))
    for factor in IDLE_FACTORS:
        found = ratio(records, OURS, PAPER, partial(energy_j, idle=factor))
        yield f"energy over `paper`, P_idle x {factor:g}", "<= 0.6", _cell(found)


def _time_s(record: Record) -> float:
    return float(record["t_s"])


def _cell(found: Ratio) -> str:
    if found.mean is None:
        return "-"
    return f"{found.mean:.2f} (worst set {found.worst:.2f}; {found.sets} sets, {found.runs} runs)"


def _share(records: Sequence[Record]) -> str:
    if not records:
        return "not run"
    truly, word = sum(map(arrived, records)), sum(record["word"] == "reached" for record in records)
    extra = f"; by its own word {word}" if word != truly else ""
    return f"{truly} of {len(records)}, {100 * truly / len(records):.1f} %{extra}"
