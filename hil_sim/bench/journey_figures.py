# SPDX-License-Identifier: MIT
"""The figures of journeys, by row and driver: speed over the ideal, goals, and what they cost."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final

import numpy as np

from hil_sim.bench.judge import BOUND_S
from hil_sim.bench.stats import quantile, rate, share

Record = dict[str, Any]
_DRAWS: Final = 2000
_TAILS: Final = (2.5, 97.5)


def summarise(records: Iterable[Record]) -> list[Record]:
    """Return the figures of each row and driver, in the order in which they were run."""
    good = {record["id"]: record for record in records if record["error"] is None}
    groups: dict[tuple[str, str], list[Record]] = {}
    for record in good.values():
        groups.setdefault((record["row"], record["driver"]), []).append(record)
    return [_figures(row, driver, group, good) for (row, driver), group in groups.items()]


def speed_mm_s(record: Record, ideal: Record | None) -> float:
    """Return the way made along the course by the clock.

    A run that gave up is counted with the time that the ideal took, at least: to give up soon is no speed.
    """
    t_s = record["t_s"]
    if ideal is not None and record["word"] == "failed":
        t_s = max(t_s, ideal["t_s"])
    return float(record["progress_mm"] / t_s) if t_s else 0.0


def over_ideal(record: Record, ideal: Record) -> float | None:
    """Return the speed of a mission over that of its ideal; None when the ideal did not get there: it is none then."""
    return speed_mm_s(record, ideal) / speed_mm_s(ideal, None) if ideal["word"] == "reached" else None


def _figures(row: str, driver: str, group: Sequence[Record], good: Mapping[str, Record]) -> Record:
    figures: Record = {"row": row, "driver": driver, "missions": len(group)}
    return figures | _arrivals(group, good) | _price(group) | _safety(group) | {"found": _found(group)}


def _total(group: Sequence[Record], name: str) -> float:
    return float(sum(record[name] for record in group))


def _per(value: float, whole: float) -> float | None:
    return round(value / whole, 1) if whole else None


def _arrivals(group: Sequence[Record], good: Mapping[str, Record]) -> Record:
    by_word = [record for record in group if record["word"] == "reached"]
    given_up = [record["t_s"] for record in group if record["word"] == "failed"]
    return {
        "speed_mm_s": _per(_total(group, "progress_mm"), _total(group, "t_s")),
        "over_ideal": _over(group, good),
        "truly": share(int(_total(group, "truly")), len(group)),
        "word": share(len(by_word), len(group)),
        "gave_up": share(len(given_up), len(group)),
        "gave_up_s": quantile(given_up, 0.5),
        "off_goal_mm": quantile([record["goal_mm"] for record in by_word], 0.5),
        "odometry_off_mm": quantile([record["odometry_off_mm"] for record in group], 0.5),
        "early_mm": _spread([record["early_mm"] for record in group]),
    }


def _price(group: Sequence[Record]) -> Record:
    hours, metres = _total(group, "t_s") / 3600, _total(group, "driven_mm") / 1000

    def counted(name: str) -> Record:
        return rate(sum(len(record[name]) for record in group), hours)

    return {
        "clock_hours": round(hours, 4),
        "metres": round(metres, 1),
        "stops": rate(int(_total(group, "stops")), hours),
        "looks": rate(int(_total(group, "looks")), hours),
        "looking_s_per_hour": _per(_total(group, "looking_s"), hours),
        "turned_deg_per_m": _per(_total(group, "turned_deg"), metres),
        "energy_j_per_m": _per(_total(group, "energy_j"), _total(group, "progress_mm") / 1000),
        "false_names": counted("false_names"),
        "false_disables": counted("false_disables"),
        "modes": _modes(group),
    }


def _safety(group: Sequence[Record]) -> Record:
    return {
        "closest_mm": _spread([r["closest_mm"] for r in group if r["closest_mm"] is not None]),
        "collisions": sum(bool(record["collisions"]) for record in group),
        "attributable": int(_total(group, "attributable")),
        "met_ahead": int(_total(group, "met_ahead")),
        "walked_into": int(_total(group, "walked_into")),
        "struck": int(_total(group, "struck")),
    }


def _over(group: Sequence[Record], good: Mapping[str, Record]) -> Record:
    """Ratio of the sums of way and time, the interval by drawing missions with replacement, and the median ratio."""
    ideals = [(record, good.get(record["ideal"])) for record in group]
    pairs = [(r, ideal) for r, ideal in ideals if ideal is not None and ideal["word"] == "reached"]
    ratios = [ratio for pair in pairs if (ratio := over_ideal(*pair)) is not None]
    if not ratios:
        return {"n": 0, "ratio": None, "low": None, "high": None, "median": None, "worst": None}
    rows = np.array([_way_and_time(*pair) for pair in pairs])
    ratio = float(_ratio(rows[None])[0])
    drawn = np.random.default_rng(1).integers(0, len(rows), (_DRAWS, len(rows)))
    low, high = np.percentile(_ratio(rows[drawn]), _TAILS)
    return {
        "n": len(ratios),
        "ratio": round(ratio, 3),
        "low": round(float(low), 3),
        "high": round(float(high), 3),
        "median": round(float(np.median(ratios)), 3),
        "worst": round(min(ratios), 3),
    }


def _way_and_time(record: Record, ideal: Record) -> tuple[float, float, float, float]:
    t_s = max(record["t_s"], ideal["t_s"]) if record["word"] == "failed" else record["t_s"]
    return record["progress_mm"], t_s, ideal["progress_mm"], ideal["t_s"]


def _ratio(rows: Any) -> Any:
    """Speed over speed of each draw: rows of way, time, ideal way and ideal time, draws x missions x 4."""
    sums = rows.sum(axis=1)
    return sums[:, 0] / sums[:, 1] * sums[:, 3] / sums[:, 2]


def _spread(values: Sequence[float]) -> Record:
    return {"n": len(values), "least": min(values, default=None), "median": quantile(values, 0.5)}


def _modes(group: Sequence[Record]) -> dict[str, float]:
    """Share of the clock in each mode."""
    seconds: Counter[str] = Counter()
    for record in group:
        seconds.update(record["modes_s"])
    whole = sum(seconds.values())
    return {name: round(value / whole, 4) for name, value in seconds.most_common() if whole}


def _found(group: Sequence[Record]) -> Record:
    """Shares of the faults found in time and ever, of those that showed for as long as their bound."""
    faults = [fault for record in group for fault in record["faults"] if fault["apart"] is None]
    kinds = {kind: [fault for fault in faults if fault["kind"] == kind] for kind in BOUND_S}
    return {kind: _shares(some) for kind, some in {"all": faults, **kinds}.items() if some}


def _shares(faults: Sequence[Record]) -> Record:
    return {
        "in_time": share(sum(fault["found"] for fault in faults), len(faults)),
        "ever": share(sum(fault["latency_s"] is not None for fault in faults), len(faults)),
    }
