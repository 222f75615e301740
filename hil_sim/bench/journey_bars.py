# SPDX-License-Identifier: MIT
"""What the journeys of profile argus must reach: a line for each bar whose row was run."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, Final

from hil_sim.bench.figures import Bar, judged_bar
from hil_sim.bench.journey import parse_row
from hil_sim.bench.journey_worlds import NO_WAY, SETS
from hil_sim.bench.judge import BOUND_S
from hil_sim.bench.stats import count_bound_high, share, share_bound_low

Record = dict[str, Any]
DRIVER: Final = "argus"
_OVER: Final[Mapping[str, float]] = {"rooms": 0.9, "rooms+rough": 0.8, "rooms+people": 0.6, "rooms+one": 0.5}
"""Speed over the ideal."""
_TRULY: Final[Mapping[str, tuple[str, float]]] = {
    "rooms": (">= 29 of 30", 29 / 30),
    "rooms+one": (">= 98 %", 0.98),
}
"""Share of the goals truly reached."""
_SETS: Final = 0.95
"""Share of the goals of each obstacle set, by the robot's word: nothing cancels odometry's drift on the way round."""
_LOOKING_S: Final[Mapping[str, float]] = {"rooms": 120.0, "rooms+rough": 300.0}
_NAMES: Final[Mapping[str, float]] = {"rooms": 10.0, "rooms+people": 40.0, "rooms+front": 0.0}
_DISABLES_100H: Final = 1.0
_FOUND: Final[Mapping[str, float]] = {"in_time": 0.849, "ever": 0.938}
"""Of a fault manager that only listened."""
_CLOSEST_MM: Final = 50.0
_EARLY_M: Final = 40.0
_MISSIONS: Final = 1000


def bars(rows: Sequence[Record]) -> list[Bar]:
    """Return the table that decides, as far as its rows were run."""
    own = {row["row"]: row for row in rows if row["driver"] == DRIVER}
    return (
        [bar for each in (_arrivals, _speeds, _prices, _wholes, _safety) for bar in each(own)] if own else []
    )


def _arrivals(own: Mapping[str, Record]) -> Iterator[Bar]:
    for name, (says, least) in _TRULY.items():
        if name in own:
            yield _share(f"{name}: goals truly reached", says, own[name]["truly"], least)
    for name in SETS:
        if name in own and name != NO_WAY:
            yield _share(f"{name}: goals reached by its word", ">= 95 %", own[name]["word"], _SETS)
    if NO_WAY in own:
        yield _share(f"{NO_WAY}: says that there is no way", ">= 95 %", own[NO_WAY]["gave_up"], 0.95)


def _share(name: str, says: str, part: Record, least: float) -> Bar:
    low = share_bound_low(part["hits"], part["of"])
    return judged_bar(name, says, part["share"], low, "%", part["of"], lambda v: v >= least)


def _speeds(own: Mapping[str, Record]) -> Iterator[Bar]:
    for name, least in _OVER.items():
        if name in own:
            over = own[name]["over_ideal"]
            yield _at_least(f"{name}: speed over the ideal", over["ratio"], over["low"], over["n"], least, "")
    if "maps+mobilesim" in own:
        early = own["maps+mobilesim"]["early_mm"]
        median, worst = (None if early[part] is None else early[part] / 1000 for part in ("median", "least"))
        yield _at_least("maps+mobilesim: way in 330 s (worst)", median, worst, early["n"], _EARLY_M, "m")


def _prices(own: Mapping[str, Record]) -> Iterator[Bar]:
    for name, most in _LOOKING_S.items():
        if name in own:
            value, cases = own[name]["looking_s_per_hour"], own[name]["missions"]
            yield _at_most(f"{name}: looking in a clock hour", value, value, cases, most, "s")
    for name, most in _NAMES.items():
        if name in own:
            rate, cases = own[name]["false_names"], own[name]["missions"]
            high = None if rate["rate"] is None else count_bound_high(rate["count"]) / rate["hours"]
            yield _at_most(f"{name}: false names in a clock hour", rate["rate"], high, cases, most, "")


def _wholes(own: Mapping[str, Record]) -> Iterator[Bar]:
    """Bars on all rows together."""
    count = sum(row["false_disables"]["count"] for row in own.values())
    hours, missions = sum(row["clock_hours"] for row in own.values()), _missions(own.values())
    per = 100 / hours if hours else 0.0
    high = count_bound_high(count) * per
    yield _at_most(
        "all rows: false disables in 100 clock hours", count * per, high, missions, _DISABLES_100H, ""
    )
    found = found_of_one(own.values()).get("all")
    if found is None:
        return
    for part, least in _FOUND.items():
        name = f"rows of one fault: found {part.replace('_', ' ')}"
        yield _share(name, f">= {100 * least:g} %", found[part], least)


def found_of_one(rows: Iterable[Record]) -> dict[str, Record]:
    """Return the shares of faults found in time and ever, by kind, of the rows with one fault together."""
    own = [row["found"] for row in rows if "one" in parse_row(row["row"]).conditions]
    return {
        kind: {
            part: share(
                *(sum(found[kind][part][name] for found in own if kind in found) for name in ("hits", "of"))
            )
            for part in _FOUND
        }
        for kind in ("all", *BOUND_S)
        if any(kind in found for found in own)
    }


def _safety(own: Mapping[str, Record]) -> Iterator[Bar]:
    hits, missions = sum(row["attributable"] for row in own.values()), _missions(own.values())
    verdict = "fail" if hits else "pass" if missions >= _MISSIONS else "open"
    name = "all rows: attributable collisions"
    yield Bar(name, "0 in 1000 missions", float(hits), None, "", missions, verdict)
    yield from _people(own)
    yield from _closest(own)


def _people(own: Mapping[str, Record]) -> Iterator[Bar]:
    # Published figures of before the split do not have it.
    peopled = [row for name, row in own.items() if parse_row(name).people and "met_ahead" in row]
    if peopled:
        met = float(sum(row["met_ahead"] for row in peopled))
        name = "rows with people: somebody met ahead"
        yield Bar(name, "0", met, None, "", _missions(peopled), "fail" if met else "pass")


def _closest(own: Mapping[str, Record]) -> Iterator[Bar]:
    healthy = [row for name, row in own.items() if not parse_row(name).has_faults]
    near = [(row["closest_mm"]["least"], row["row"]) for row in healthy if row["closest_mm"]["n"]]
    if near:
        least, where = min(near)
        name = f"healthy rows: closest to a wall in free driving (in {where})"
        yield _at_least(name, least, least, _missions(healthy), _CLOSEST_MM, "mm")


def _missions(rows: Iterable[Record]) -> int:
    return sum(row["missions"] for row in rows)


def _at_least(name: str, value: float | None, low: float | None, cases: int, least: float, unit: str) -> Bar:
    return judged_bar(name, f">= {least:g} {unit}".rstrip(), value, low, unit, cases, lambda v: v >= least)


def _at_most(name: str, value: float | None, high: float | None, cases: int, most: float, unit: str) -> Bar:
    return judged_bar(name, f"<= {most:g} {unit}".rstrip(), value, high, unit, cases, lambda v: v <= most)
