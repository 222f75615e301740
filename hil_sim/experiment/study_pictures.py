# SPDX-License-Identifier: MIT
"""Pictures of the study of journeys: goals, time, energy, stops, turning and the closest approach."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from statistics import median
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes

from hil_sim.experiment.cases import ARRAYS, HEALTHY, POLICIES
from hil_sim.experiment.pictures import COLOURS, picture
from hil_sim.experiment.study import arrived, energy_j, group_of

Record = dict[str, Any]
_COUNTS: Final = (HEALTHY, "1", "2", "3", "4", "5", "6", ARRAYS[0])
_LABELS: Final = ("0", "1", "2", "3", "4", "5", "6", "front\narray")
_APART: Final = len(_COUNTS) - 1.5
"""Left of here a place is a number of dead sonars; the lost array is another case and no step of that scale."""
_HATCH: Final = {"paper": "//", "adaptive": ""}


def draw(folder: Path, records: Sequence[Record]) -> None:
    """Draw all pictures of the study."""
    plain = [record for record in records if record["day"] == "plain"]
    draw_main(folder / "journeys.png", plain)
    draw_price(folder / "price.png", plain)


def _of(records: Sequence[Record], policy: str, group: str) -> list[Record]:
    return [r for r in records if r["policy"] == policy and group_of(r["dead"]) == group]


def draw_main(path: Path, records: Sequence[Record]) -> None:
    """Draw the one picture that says most: goals and time by the number of dead sonars, the paper's method and ours."""
    with picture(path, (9.0, 3.9)) as figure:
        left, right = figure.subplots(1, 2)
        for k, policy in enumerate(("paper", "adaptive")):
            own = [_of(records, policy, group) for group in _COUNTS]
            at = np.arange(len(_COUNTS)) + (k - 0.5) * 0.4
            _bars(left, policy, at, [_percent(rs) for rs in own])
            times = [_median([r["t_s"] for r in rs if arrived(r)]) for rs in own]
            _bars(right, policy, at, times)
            _say_none(right, policy, at, times)
        for place, title in ((left, "goals truly reached, %"), (right, "median time to the goal, s")):
            place.set_xticks(range(len(_LABELS)), _LABELS)
            place.set_xlabel("dead front sonars, from the start")
            place.set_title(title, fontsize=10)
            place.grid(axis="x", visible=False)
        left.set_ylim(0, 105)
        right.legend(fontsize=8, loc="upper left")


def _say_none(place: Axes, policy: str, at: Any, heights: Sequence[float]) -> None:
    for x, height in zip(at, heights, strict=True):
        if not height:
            place.text(x, 2, "none", ha="center", rotation=90, fontsize=7, color=COLOURS[policy])


def _bars(place: Axes, policy: str, at: Any, heights: Sequence[float]) -> None:
    label = "the paper's method" if policy == "paper" else "argus, adaptive"
    place.bar(at, heights, 0.4, color=COLOURS[policy], hatch=_HATCH[policy], edgecolor="white", label=label)


def _percent(records: Sequence[Record]) -> float:
    return 100 * sum(map(arrived, records)) / len(records) if records else 0.0


def _median(values: Sequence[float]) -> float:
    return median(values) if values else 0.0


def draw_price(path: Path, records: Sequence[Record]) -> None:
    """Draw what a journey takes, by policy and number of dead sonars, on journeys that end at the goal."""
    wanted: tuple[tuple[str, Callable[[Record], float | None]], ...] = (
        ("time, s", lambda r: float(r["t_s"])),
        ("energy, J", energy_j),
        ("stops", lambda r: float(r["stops"])),
        ("turning, degrees", lambda r: float(r["turned_deg"])),
        ("closest approach, mm", lambda r: r["closest_mm"]),
    )
    with picture(path, (10.0, 6.0)) as figure:
        places = figure.subplots(2, 3).ravel()
        for place, (title, quantity) in zip(places, wanted, strict=False):
            _lines(place, records, quantity)
            place.set_title(title, fontsize=10)
            place.set_ylim(0, 1.08 * place.dataLim.y1)  # no mark is cut off at the edge
            place.set_xticks(range(len(_LABELS)), _LABELS, fontsize=8)
            place.set_xlabel("dead front sonars", fontsize=8)
            place.axvline(_APART, color="#bbbbbb", linewidth=0.8)
            place.grid(axis="x", visible=False)
        places[-1].axis("off")
        handles, labels = places[0].get_legend_handles_labels()
        places[-1].legend(
            handles, labels, loc="center", fontsize=9, title="median of the journeys at the goal"
        )


def _medians(
    records: Sequence[Record], policy: str, quantity: Callable[[Record], float | None]
) -> list[tuple[int, float]]:
    """Return the median of a quantity for each number of dead sonars of which journeys arrived."""
    points = []
    for k, group in enumerate(_COUNTS):
        values = [quantity(r) for r in _of(records, policy, group) if arrived(r)]
        known = [value for value in values if value is not None]
        if known:
            points.append((k, median(known)))
    return points


def _lines(place: Axes, records: Sequence[Record], quantity: Callable[[Record], float | None]) -> None:
    marks = dict(zip(POLICIES, "so^vD", strict=True))
    for n, policy in enumerate(POLICIES):
        aside = 0.13 * (n - (len(POLICIES) - 1) / 2)  # policies that take the same are both seen
        points = _medians(records, policy, quantity)
        style: dict[str, Any] = {"marker": marks[policy], "color": COLOURS[policy], "markersize": 5}
        for part, label in (
            ([point for point in points if point[0] < _APART], policy),
            ([point for point in points if point[0] > _APART], None),
        ):
            if part:
                xs, ys = zip(*part, strict=True)
                place.plot([x + aside for x in xs], ys, label=label, linewidth=1.3, **style)
