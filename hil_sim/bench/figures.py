# SPDX-License-Identifier: MIT
"""The figures of a bench: rates with bounds, latencies, the confusion matrix, and the bars that they must clear."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Final

from hil_sim.bench.judge import BOUND_S, REFRESH_S, SHOWN_READINGS
from hil_sim.bench.plan import FORWARD, SONARS, sonar_defaults
from hil_sim.bench.stats import beta_cdf, count_bound_high, quantile, share_bound_low, share_interval

Record = dict[str, Any]
KINDS: Final = tuple(BOUND_S)
NOT_FOUND: Final = "not found"
SURE: Final = ("off", "stuck", "garbage", "slow")
"""Kinds of which 99 % must be found; of the others 97 %."""
HARD: Final = ("wrong", "intermittent")
QUICK: Final = ("off", "garbage", "slow")
"""Kinds that must be found within 2 s (median) and 10 s (p99); the others within 5 s and 30 s."""
SLOWER: Final = ("silent", "stuck", "wrong", "intermittent")


ROOMS: Final = ("room",)
EVERYWHERE: Final = ("room", "open")
OBSERVED: Final = {
    "sure": (SURE, EVERYWHERE),
    "hard": (HARD, EVERYWHERE),
    "sure_rooms": (SURE, ROOMS),
    "hard_rooms": (HARD, ROOMS),
    "quick_rooms": (QUICK, ROOMS),
    "slower_rooms": (SLOWER, ROOMS),
}
"""Of which kinds in which places the report tells what could be found."""


@dataclass(frozen=True)
class Bar:
    """One line of the table that decides. verdict: pass, open (the value clears it, its 95 % bound does not), fail."""

    name: str
    bar: str
    value: float | None
    bound: float | None
    unit: str
    cases: int
    verdict: str


_Point = tuple[tuple[str, float], ...]
"""Names and values of the parameters of the sonar model that are not as by default."""


def summarise(records: Iterable[Record]) -> dict[str, Any]:
    """Return the figures of all profiles, and of each point of a sensitivity sweep."""
    result: dict[str, Any] = {"profiles": {}, "sensitivity": []}
    by_profile: dict[str, dict[_Point, list[Record]]] = {}
    for record in records:
        if record["error"] is None:
            points = by_profile.setdefault(record["profile"], {(): []})
            points.setdefault(tuple(sorted(record["sonar"].items())), []).append(record)
    for profile, points in by_profile.items():
        plain = points.pop(())
        result["profiles"][profile] = figures(plain)
        defaults = [((name, value),) for name, value in sonar_defaults().items()] if points else []
        result["sensitivity"] += [_point(profile, point, plain) for point in defaults]
        result["sensitivity"] += [_point(profile, point, points[point]) for point in sorted(points)]
    return result


def _point(profile: str, point: _Point, records: Sequence[Record]) -> dict[str, Any]:
    whole = figures(records)
    return {
        "profile": profile,
        "parameter": point[0][0],
        "value": point[0][1],
        "found": {kind: row["rate"] for kind, row in whole["kinds"].items() if row["judged"]},
        "judged": whole["all"]["judged"],
        "not_injected": whole["not_injected"],
        "found_all": whole["all"]["rate"] if whole["all"]["judged"] else None,
        "found_interval": whole["all"]["interval"],
        "false_per_100h": whole["false_disables"]["per_100h"],
        "false_per_100h_high": whole["false_disables"]["per_100h_high"],
        "hours": whole["false_disables"]["hours"],
    }


def figures(records: Sequence[Record]) -> dict[str, Any]:
    """Return the figures of one profile."""
    faults = _faults(records)
    free, tried = _free(records, True), _free(records, False)
    hours = sum(record["t_s"] for record in records) / 3600
    result: dict[str, Any] = {
        "missions": len(records),
        "clock_hours": round(hours, 3),
        "not_injected": sum(not record["faults"] for record in tried),
        "reached": {"fault-free": _reached(free), "with faults": _reached(tried)},
        "kinds": {kind: _detection(_of(faults, (kind,))) for kind in KINDS},
        "pairs": _detection(_of_variant(faults, "pair")),
        "variants": {name: _detection(_of_variant(faults, name)) for name in _variants(faults)},
        "all": _detection(faults),
        "ideal": {name: _ideal(_of(faults, kinds, places)) for name, (kinds, places) in OBSERVED.items()},
        "doubted": {"sure": _doubted(_of(faults, SURE)), "hard": _doubted(_of(faults, HARD))},
        "confusion": _confusion(faults, records),
        "false_disables": _false(free),
        "false_disables_with_faults": _false(tried),
        "false_names": _false(free, "false_names"),
        "rehabilitation": _rehabilitation(faults),
        "verification": _verification(records),
        "collisions": _collisions(records),
    }
    result["bars"] = [asdict(bar) for bar in bars(result, faults)]
    return result


def _of(faults: Sequence[Record], kinds: Sequence[str], places: Sequence[str] = EVERYWHERE) -> list[Record]:
    return [fault for fault in faults if fault["kind"] in kinds and fault["place"] in places]


def _faults(records: Sequence[Record]) -> list[Record]:
    """All faults, with what is told of their missions."""
    return [fault | {"place": r["place"], "variant": r["variant"]} for r in records for fault in r["faults"]]


def _free(records: Sequence[Record], free: bool) -> list[Record]:
    """The missions without faults, or those with."""
    return [record for record in records if record["variant"].startswith("free") == free]


def _variants(faults: Sequence[Record]) -> list[str]:
    return sorted({fault["variant"] for fault in faults})


def _of_variant(faults: Sequence[Record], variant: str) -> list[Record]:
    return [fault for fault in faults if fault["variant"] == variant]


def _reached(records: Sequence[Record]) -> dict[str, Any]:
    return _share(sum(record["reached"] for record in records), len(records))


def _share(hits: int, total: int) -> dict[str, Any]:
    return {
        "hits": hits,
        "of": total,
        "rate": _r(hits / total) if total else None,
        "low": math.floor(1e5 * share_bound_low(hits, total)) / 1e5,  # never rounded across a bar
        "interval": [_r(v) for v in share_interval(hits, total)],
    }


def _detection(faults: Sequence[Record]) -> dict[str, Any]:
    judged = _judged(faults)
    found = [fault for fault in judged if fault["found"]]
    seen = [fault for fault in judged if fault["latency_s"] is not None]
    rooms = _of(seen, KINDS, ROOMS)
    whole = _share(len(found), len(judged))
    return {
        "injected": len(faults),
        "apart": _counts(faults, "apart"),
        "judged": len(judged),
        "found": len(found),
        "late": len(seen) - len(found),
        "never": len(judged) - len(seen),
        "rate": whole["rate"],
        "low": whole["low"],
        "interval": whole["interval"],
        "forward": _share_of([fault for fault in judged if fault["sonar"] in FORWARD], "found"),
        "visible_once": _share_of(_visible_once(faults), "found"),
        "named": _share_of(found, "named_right"),
        "named_end": _share_of(found, "named_end_right"),
        "latency_s": _spread_of(rooms, "latency_s"),
        "latency_mm": _spread_of(rooms, "latency_mm"),
        "latency_s_everywhere": _spread_of(seen, "latency_s"),
    }


def _judged(faults: Sequence[Record]) -> list[Record]:
    return [fault for fault in faults if fault["apart"] is None]


def _visible_once(faults: Sequence[Record]) -> list[Record]:
    """Those that showed in a reading at least once, and had their time."""
    return [f for f in faults if f["apart"] in (None, "not shown") and f["visible_s"] is not None]


def _counts(faults: Sequence[Record], what: str) -> dict[str, int]:
    return dict(Counter(fault[what] for fault in faults if fault[what]))


def _share_of(faults: Sequence[Record], what: str) -> dict[str, Any]:
    return _share(sum(fault[what] for fault in faults), len(faults))


def _spread_of(faults: Sequence[Record], what: str) -> dict[str, Any]:
    return _spread([fault[what] for fault in faults])


def readings_wanted(window_s: float, crosstalk: float, fired: int | None = None) -> int:
    """Return how many readings of a window must be off before a fault is sure, by this count alone.

    It is the smallest count that crosstalk brings 16 healthy sonars to in less than one of the successive windows of
    100 h. `crosstalk`: share of the readings, 0 to 1. `fired`: readings of each sonar; default: as often as all take
    turns.
    """
    fired = int(window_s / REFRESH_S) if fired is None else fired
    windows = SONARS * 100 * 3600 / window_s
    return next((n for n in range(1, fired) if windows * beta_cdf(crosstalk, n, fired - n + 1) <= 1.0), fired)


def _ideal(faults: Sequence[Record]) -> dict[str, Any]:
    """What two observers would find in time that count the readings that are off.

    The first knows each true range. `three`: three are enough for it, so by its count alone it errs thousands of times
    in 100 h. `once`: so many, of those that the sonar gave, that it errs once; `once_latency_s`: when it is sure then.
    `peers`: the second counts only those of the first that another sonar contradicts, and wants as many as `once`.
    What was found by less, such as one value again and again, is found by both too.
    """
    judged = _judged(faults)
    crosstalk = sonar_defaults()["crosstalk"]

    def found(count: str, wanted: Callable[[Record], int]) -> dict[str, Any]:
        return _share(sum(f["found"] or f[count] >= wanted(f) for f in judged), len(judged))

    def sure(fault: Record) -> int:
        return max(1, readings_wanted(BOUND_S[fault["kind"]], crosstalk, fault["readings_in_time"]))

    return {
        "three": found("visible_in_time", lambda _: SHOWN_READINGS),
        "once": found("visible_in_time", sure),
        "peers": found("contradicted_in_time", sure),
        "measured": _share(sum(f["found"] for f in judged), len(judged)),
        "latency_s": _spread([f["latency_s"] for f in judged if f["latency_s"] is not None]),
        "once_latency_s": _spread([at for f in judged if (at := _sure_at(f, sure(f))) is not None]),
    }


def _sure_at(fault: Record, wanted: int) -> float | None:
    """When the observer of the truth is sure, or the fault was found, if that was sooner; None: never."""
    times = [fault["latency_s"], *fault["visible_at"][wanted - 1 : wanted]]
    return min((float(t) for t in times if t is not None), default=None)


def _doubted(faults: Sequence[Record]) -> dict[str, Any]:
    """What was DISABLED or a SUSPECT of any kind in time, perhaps by a wrong name."""
    judged = _judged(faults)
    in_time = [f["doubted_s"] is not None and f["doubted_s"] <= BOUND_S[f["kind"]] for f in judged]
    return _share(sum(in_time), len(in_time))


def _spread(values: Sequence[float]) -> dict[str, Any]:
    return {"n": len(values), "median": quantile(values, 0.5), "p99": quantile(values, 0.99)}


def _confusion(faults: Sequence[Record], records: Sequence[Record]) -> dict[str, dict[str, int]]:
    """Injected kind to named kind, of those judged; the row `none` counts the false disables.

    A right name counts as the kind that was injected.
    """
    table: dict[str, dict[str, int]] = {}
    for kind in KINDS:
        judged = [f for f in faults if f["kind"] == kind and f["apart"] is None]
        table[kind] = dict(Counter(_called(fault) for fault in judged))
    table["none"] = dict(Counter(one["kind"] for record in records for one in record["false_disables"]))
    return table


def _called(fault: Record) -> str:
    if not fault["found"]:
        return NOT_FOUND
    return str(fault["kind"] if fault["named_right"] else fault["named"])


def _false(records: Sequence[Record], what: str = "false_disables") -> dict[str, Any]:
    count = sum(len(record[what]) for record in records)
    hours = sum(record["t_s"] for record in records) / 3600
    return {
        "count": count,
        "hours": round(hours, 3),
        "missions": len(records),
        "per_100h": round(100 * count / hours, 3) if hours else None,
        "per_100h_high": math.ceil(1e5 * count_bound_high(count) / hours) / 1e3 if hours else None,
    }


def _rehabilitation(faults: Sequence[Record]) -> dict[str, Any]:
    counts = Counter(fault["rehabilitation"] for fault in faults if fault["rehabilitation"])
    tried = counts["back"] + counts["late"] + counts["never"]
    times = [f["rehabilitated_s"] for f in faults if f["rehabilitated_s"] is not None]
    return _share(counts["back"], tried) | {"counts": dict(counts), "driving_s": _spread(times)}


def _verification(records: Sequence[Record]) -> dict[str, Any]:
    hours = sum(record["t_s"] for record in records) / 3600

    def per_hour(name: str) -> float | None:
        return round(sum(record[name] for record in records) / hours, 2) if hours else None

    return {
        "stops_per_h": per_hour("stops"),
        "verifications_per_h": per_hour("verifications"),
        "verifying_s_per_h": per_hour("verifying_s"),
    }


def _collisions(records: Sequence[Record]) -> dict[str, int]:
    hit = [record for record in records if record["collisions"]]
    return {
        "missions": len(records),
        "attributable": sum(record["attributable"] for record in hit),
        "undetected": sum(record["undetected"] for record in hit),
        "other": sum(not record["attributable"] for record in hit),
        "struck": sum(record["struck"] for record in records),
    }


# ---- the bars ---------------------------------------------------------------------------------------------------


def bars(figure: Record, faults: Sequence[Record]) -> list[Bar]:
    """Return the table that decides, in the order in which it was asked for."""

    def of(kinds: Sequence[str]) -> dict[str, Any]:
        return _detection(_of(faults, kinds))

    def at_least(name: str, share: Record, least: float) -> Bar:
        return _at_least(name, share["rate"], share["low"], share["of"], least)

    sure, hard = of(SURE), of(HARD)
    rows = [
        _at_least("found: off, stuck, garbage, slow", sure["rate"], sure["low"], sure["judged"], 0.99),
        _at_least("found: wrong, intermittent", hard["rate"], hard["low"], hard["judged"], 0.97),
        at_least("kind named correctly when found", figure["all"]["named"], 0.95),
    ]
    false = figure["false_disables"]
    rows.append(
        _at_most(
            "false disables in 100 fault-free clock hours",
            false["per_100h"],
            false["per_100h_high"],
            false["missions"],
            1.0,
            "",
        )
    )
    for kinds, median, p99 in ((QUICK, 2.0, 10.0), (SLOWER, 5.0, 30.0)):
        spread = of(kinds)["latency_s"]
        for part, limit in (("median", median), ("p99", p99)):
            rows.append(
                _at_most(
                    f"latency {part} in rooms: {', '.join(kinds)}",
                    spread[part],
                    spread[part],
                    spread["n"],
                    limit,
                    "s",
                )
            )
    rows.append(at_least("repaired sonar HEALTHY within 60 s of driving", figure["rehabilitation"], 0.95))
    hits, missions = figure["collisions"]["undetected"], figure["missions"]
    rows.append(
        Bar(
            "collisions attributable to an undetected fault",
            "0 in 1000 missions",
            float(hits),
            None,
            "",
            missions,
            "fail" if hits else "pass" if missions >= 1000 else "open",
        )
    )
    return rows


def _at_least(name: str, value: float | None, low: float, cases: int, least: float) -> Bar:
    return judged_bar(name, f">= {100 * least:g} %", value, low, "%", cases, lambda v: v >= least)


def _at_most(name: str, value: float | None, high: float | None, cases: int, most: float, unit: str) -> Bar:
    return judged_bar(name, f"<= {most:g} {unit}".rstrip(), value, high, unit, cases, lambda v: v <= most)


def judged_bar(
    name: str,
    bar: str,
    value: float | None,
    bound: float | None,
    unit: str,
    cases: int,
    clears: Callable[[float], bool],
) -> Bar:
    """Return a line of the table that decides, judged by its value and by its 95 % bound."""
    if value is None or not cases:
        verdict = "open"
    elif not clears(value):
        verdict = "fail"
    else:
        verdict = "pass" if bound is not None and clears(bound) else "open"
    return Bar(name, bar, value, bound, unit, cases, verdict)


def _r(value: float) -> float:
    return round(value, 9)
