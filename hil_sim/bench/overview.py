# SPDX-License-Identifier: MIT
"""Pictures of published figures: journeys by row, faults found in time by kind, how fast simulators are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import Any, Final

from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hil_sim.bench.figures import KINDS
from hil_sim.bench.journey import IDEAL, parse_row

Record = dict[str, Any]
Share = tuple[float, float, float]
"""A value, and the ends of its interval."""
_STYLE: Final[Any] = {"font.size": 9, "axes.grid": True, "grid.color": "#dddddd", "axes.axisbelow": True}
# Okabe and Ito's palette: told apart by colour-blind readers; in grey by the marks.
_ARGUS: Final = {"color": "#0072B2", "marker": "o"}
_IDEAL: Final = {"color": "#777777", "marker": "s"}


def _save(figure: Figure, path: Path, source: str) -> None:
    """Write a picture that says which figures it shows; the same bytes each time."""
    figure.savefig(path, dpi=110, metadata={"Software": None, "Source": source})


def _dots(place: Axes, shares: Mapping[float, Share], label: str, style: Mapping[str, Any]) -> None:
    """Draw values at their places with their intervals, in percent."""
    if not shares:
        return
    at = list(shares)
    x = [100 * value for value, _, _ in shares.values()]
    left = [100 * (value - low) for value, low, _ in shares.values()]
    right = [100 * (high - value) for value, _, high in shares.values()]
    place.errorbar(x, at, xerr=[left, right], linestyle="none", capsize=3, label=label, **style)


def _named(place: Axes, names: Sequence[str]) -> None:
    place.set_yticks(range(len(names)), names)
    place.set_ylim(len(names) - 0.5, -0.5)
    place.grid(axis="y", visible=False)


def draw_journeys(path: Path, source: str, journeys: Record) -> None:
    """Draw for each row the goals truly reached, and the speed over that of the ideal."""
    rows = {(row["row"], row["driver"]): row for row in journeys["rows"]}
    argus = [row for (_, driver), row in rows.items() if driver == "argus"]
    goals, ideal, speed = {}, {}, {}
    for at, row in enumerate(argus):
        goals[at + 0.12] = _share(row["truly"], "share")
        if healthy := rows.get((parse_row(row["row"]).healthy, IDEAL)):
            ideal[at - 0.12] = _share(healthy["truly"], "share")
        if row["over_ideal"]["ratio"] is not None:
            speed[float(at)] = _share(row["over_ideal"], "ratio")
    with rc_context(_STYLE):
        figure = Figure(figsize=(9.0, 1.4 + 0.5 * len(argus)), layout="constrained")
        left, right = figure.subplots(1, 2, sharey=True)
        _dots(left, ideal, "ideal: the same courses, no fault, diagnosis off", _IDEAL)
        _dots(left, goals, "argus", _ARGUS)
        _dots(right, speed, "argus", _ARGUS)
        _named(left, [f"{parse_row(row['row']).says}\n({row['missions']} missions)" for row in argus])
        left.set(xlabel="goals truly reached, %", xlim=(0, 102))
        right.set(xlabel="speed over that of the ideal, %", xlim=(0, 110))
        right.axvline(100, color="#888888", linewidth=0.8)
        figure.legend(*left.get_legend_handles_labels(), loc="outside upper left", ncols=2, fontsize=8)
        _save(figure, path, source)


def _share(found: Record, value: str) -> Share:
    return found[value], found["low"], found["high"]


def _by_drive(kinds: Record) -> dict[float, Share]:
    """Return the shares of the kinds of which there were faults."""
    return {
        float(at): (kinds[kind]["rate"], *kinds[kind]["interval"])
        for at, kind in enumerate(KINDS)
        if kinds[kind]["rate"] is not None
    }


def draw_found(path: Path, source: str, listening: Record, driving: Record) -> None:
    """Draw for each kind which part of the faults was found in time: by listening alone, and by a robot that drives."""
    heard = {kind: row["in_time"] for kind, row in listening["found"].items() if kind in KINDS}
    kinds = driving["profiles"]["argus"]["kinds"]
    with rc_context(_STYLE):
        figure = Figure(figsize=(9.0, 3.6), layout="constrained")
        left, right = figure.subplots(1, 2)
        by_ear = {float(at): _share(heard[kind], "share") for at, kind in enumerate(KINDS) if kind in heard}
        _dots(left, by_ear, "", _ARGUS)
        _named(left, [f"{kind} ({heard[kind]['of'] if kind in heard else 0})" for kind in KINDS])
        _dots(right, _by_drive(kinds), "", _ARGUS)
        _named(right, [f"{kind} ({kinds[kind]['judged']})" for kind in KINDS])
        left.set_title("by listening alone (bench drive-by)", fontsize=10)
        right.set_title("by a robot that drives itself (bench diagnosis)", fontsize=10)
        for place in (left, right):
            place.set(xlabel="found in time, % of the faults (their number)", xlim=(-3, 103))
        _save(figure, path, source)


def draw_speeds(path: Path, source: str, found: Record) -> None:
    """Draw how much faster than real time simulators are: the median of the rounds, least and greatest."""
    rows = [row for row in found["rows"] if row["of"] == "robot seconds a second"]
    with rc_context(_STYLE):
        figure = Figure(figsize=(9.0, 1.0 + 0.4 * len(rows)), layout="constrained")
        place = figure.subplots()
        for at, row in enumerate(rows):
            low, middle, high = min(row["values"]), median(row["values"]), max(row["values"])
            style: Mapping[str, Any] = _IDEAL if "ir-sim" in row["what"] else _ARGUS
            spread = [[middle - low], [high - middle]]
            place.errorbar([middle], [at], xerr=spread, linestyle="none", capsize=3, **style)
        _named(place, [row["what"] for row in rows])
        place.set(xlabel="robot seconds a second of one core")
        place.set_xlim(left=0)
        _save(figure, path, source)
