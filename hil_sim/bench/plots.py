# SPDX-License-Identifier: MIT
"""Pictures of a bench: latencies, kinds taken for others, trade-offs and sensitivity, as PNG and SVG."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hil_sim.bench.figures import KINDS, NOT_FOUND, Record
from hil_sim.bench.judge import BOUND_S

# Okabe and Ito's palette and line styles: told apart by colour-blind readers and in grey.
_COLOURS: Final = ("#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#222222")
_DASHES: Final[Any] = ("-", "--", "-.", ":", (0, (7, 2)), (0, (1, 2)), (0, (4, 1, 1, 1, 1, 1)))
_MARKS: Final = ("o", "s", "^", "D", "v", "P", "X")
_STYLE: Final[Any] = {"svg.hashsalt": "argus", "font.size": 9, "axes.grid": True, "grid.color": "#dddddd"}
_LEAST_S: Final = 0.05
"""Latencies below a SIP's time are drawn here: the axis is logarithmic."""


@contextmanager
def picture(folder: Path, name: str, size: tuple[float, float]) -> Iterator[Figure]:
    """Give a figure and write it as PNG and SVG, the same bytes each time."""
    with rc_context(_STYLE):
        figure = Figure(figsize=size, layout="constrained")
        yield figure
        for suffix, fixed in (("png", {"Software": None}), ("svg", {"Date": None})):
            figure.savefig(folder / f"{name}.{suffix}", dpi=120, metadata=fixed)


def draw(folder: Path, summary: Record, records: Sequence[Record]) -> None:
    """Draw all pictures that the results are enough for."""
    plain = [record for record in records if record["error"] is None and not record["sonar"]]
    profiles: Mapping[str, Record] = summary["profiles"]
    if any(record["faults"] for record in plain):
        _latencies(folder, plain, list(profiles))
        _confusions(folder, profiles)
    if len(profiles) > 1:
        _trade(folder, profiles)
    if summary["sensitivity"]:
        _sensitivity(folder, summary["sensitivity"])


def _latencies(folder: Path, records: Sequence[Record], profiles: Sequence[str]) -> None:
    with picture(folder, "latency", (5.2 * len(profiles), 4.2)) as figure:
        axes = figure.subplots(1, len(profiles), sharey=True, squeeze=False)[0]
        for place, profile in zip(axes, profiles, strict=True):
            for k, kind in enumerate(KINDS):
                _steps(place, records, profile, kind, k)
            for limit in sorted(set(BOUND_S.values())):
                place.axvline(limit, color="#888888", linewidth=0.8)
            place.set(xscale="log", xlim=(_LEAST_S, 400), ylim=(0, 1.02), title=profile)
            place.set_xlabel("s from the first visible reading, in rooms")
            _legend(place, 7)
        axes[0].set_ylabel("share of the faults found by then")


def _steps(place: Axes, records: Sequence[Record], profile: str, kind: str, k: int) -> None:
    judged = [
        fault
        for record in records
        if record["profile"] == profile and record["place"] == "room"
        for fault in record["faults"]
        if fault["kind"] == kind and fault["apart"] is None
    ]
    if not judged:
        return
    times = np.sort([max(_LEAST_S, f["latency_s"]) for f in judged if f["latency_s"] is not None])
    xs = np.concatenate(([_LEAST_S], times, [400.0]))
    ys = np.concatenate(([0.0], np.arange(1, len(times) + 1), [float(len(times))])) / len(judged)
    label = f"{kind} ({len(judged)})"
    place.step(xs, ys, where="post", color=_COLOURS[k], linestyle=_DASHES[k], label=label)


def _confusions(folder: Path, profiles: Mapping[str, Record]) -> None:
    columns = [*KINDS, "none", NOT_FOUND]
    with picture(folder, "confusion", (5.4 * len(profiles), 4.4)) as figure:
        axes = figure.subplots(1, len(profiles), squeeze=False, sharey=True)[0]
        axes[0].set_ylabel("injected")
        for place, (profile, one) in zip(axes, profiles.items(), strict=True):
            counts = np.array(
                [[one["confusion"][kind].get(c, 0) for c in columns] for kind in KINDS], dtype=float
            )
            total = counts.sum(axis=1, keepdims=True)
            shares = np.divide(counts, total, out=np.zeros_like(counts), where=total > 0)
            place.imshow(shares, cmap="Blues", vmin=0, vmax=1, aspect="auto")
            place.grid(visible=False)
            place.set_xticks(range(len(columns)), columns, rotation=40, ha="right")
            place.set_yticks(range(len(KINDS)), KINDS)
            place.set(title=f"{profile}: {total.sum():.0f} faults, % of each kind", xlabel="named")
            if not counts.any():
                _say_nothing(place)
            for (row, column), share in np.ndenumerate(shares):
                if counts[row, column]:
                    ink = "white" if share > 0.6 else "#222222"
                    place.text(
                        column, row, f"{100 * share:.0f}", ha="center", va="center", color=ink, fontsize=8
                    )


def _trade(folder: Path, profiles: Mapping[str, Record]) -> None:
    """Found against what is said of healthy sonars, one point for each set of settings."""
    with picture(folder, "trade-off", (9.6, 4.4)) as figure:
        given_up, named = figure.subplots(1, 2, sharey=True)
        for k, (profile, one) in enumerate(profiles.items()):
            for place, false, hours in ((given_up, "false_disables", 100), (named, "false_names", 1)):
                _trade_point(place, k, profile, one, false, hours)
        given_up.axvline(1.0, color="#888888", linewidth=0.8)
        given_up.set_xscale("symlog", linthresh=1.0)
        given_up.set(
            xlabel="false disables in 100 fault-free clock hours", ylabel="share of all faults found in time"
        )
        lows = [one["all"]["interval"][0] for one in profiles.values() if one["all"]["rate"] is not None]
        given_up.set(ylim=(max(0.0, min(lows, default=0.0) - 0.05), 1.02), xlim=(-0.1, None))
        named.set(xlabel="false names in a fault-free clock hour", xscale="symlog", xlim=(0, None))
        _legend(named, 8, "lower left")


def _trade_point(place: Axes, k: int, profile: str, one: Record, false: str, hours: int) -> None:
    found, x = one["all"], one[false]["per_100h"]
    if x is None or found["rate"] is None:
        return
    x, high_x = x * hours / 100, one[false]["per_100h_high"] * hours / 100
    low, high = found["interval"]
    style: dict[str, Any] = {
        "color": _COLOURS[k % 7],
        "marker": _MARKS[k % 7],
        "capsize": 3,
        "label": profile,
    }
    error = [[found["rate"] - low], [high - found["rate"]]]
    right = [[0.0], [high_x - x]]
    place.errorbar([x], [found["rate"]], yerr=error, xerr=right, linestyle="none", **style)


def _legend(place: Axes, size: int, loc: Literal["best", "lower left"] = "best") -> None:
    """Tell the lines apart, or that there is none."""
    if place.get_legend_handles_labels()[0]:
        place.legend(loc=loc, fontsize=size, framealpha=0.9)
    else:
        _say_nothing(place)


def _say_nothing(place: Axes) -> None:
    place.text(0.5, 0.5, "nothing to judge", transform=place.transAxes, ha="center", color="#666666")


def _sensitivity(folder: Path, points: Sequence[Record]) -> None:
    names = list(dict.fromkeys(point["parameter"] for point in points))
    with picture(folder, "sensitivity", (5.0 * len(names), 6.4)) as figure:
        axes = figure.subplots(2, len(names), squeeze=False, sharex="col")
        for column, name in enumerate(names):
            for k, profile in enumerate(dict.fromkeys(point["profile"] for point in points)):
                own = [p for p in points if p["parameter"] == name and p["profile"] == profile]
                style: dict[str, Any] = {"color": _COLOURS[k % 7], "marker": _MARKS[k % 7], "label": profile}
                _sweep((axes[0][column], axes[1][column]), own, style)
            axes[0][column].set(ylabel="share of all faults found in time", ylim=(0, 1.02))
            axes[1][column].set(xlabel=name, ylabel="false disables / 100 h")
            axes[1][column].set_yscale("symlog", linthresh=1.0)
            axes[1][column].set_ylim(bottom=-0.3)
            _legend(axes[0][column], 8)


def _sweep(places: tuple[Axes, Axes], points: Sequence[Record], style: Mapping[str, Any]) -> None:
    """Draw what is found and what is falsely disabled along one parameter."""
    points = sorted(points, key=lambda p: p["value"])
    found = [(p["value"], p["found_all"], *p["found_interval"]) for p in points if p["judged"]]
    _line(places[0], found, style)
    false = [
        (p["value"], p["false_per_100h"], p["false_per_100h"], p["false_per_100h_high"])
        for p in points
        if p["hours"]
    ]
    _line(places[1], false, style)


def _line(place: Axes, points: Sequence[tuple[float, float, float, float]], style: Mapping[str, Any]) -> None:
    """Draw x, y and the bounds of y."""
    if points:
        x, y, low, high = np.array(points).T
        place.errorbar(x, y, yerr=[y - low, high - y], capsize=3, elinewidth=0.8, **style)
