# SPDX-License-Identifier: MIT
"""Pictures of journeys: the way over the map beside that of the ideal, with stops and looks marked, as PNG and SVG."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from hil_sim.bench.journey import IDEAL, mission_of, parse_id, parse_row
from hil_sim.bench.journey_figures import speed_mm_s
from hil_sim.bench.plots import picture
from hil_sim.world.files import load_world

Record = dict[str, Any]
_WIDTH_IN: Final = 8.0
_HEIGHT_IN: Final = (3.0, 9.0)
_MARGIN_MM: Final = 400.0
# Okabe and Ito's palette: told apart by colour-blind readers; in grey by marks and dashes.
_IDEAL, _DRIVEN, _STOP, _LOOK, _HIT = "#999999", "#0072B2", "#E69F00", "#CC79A7", "#D55E00"


def differs_most(records: Sequence[Record]) -> list[tuple[Record, Record]]:
    """Return for each row and profile the mission that is slowest against its ideal, and that ideal."""
    good = {record["id"]: record for record in records if record["error"] is None}
    rows: dict[tuple[str, str], list[tuple[Record, Record]]] = {}
    for record in good.values():
        if record["driver"] != IDEAL and record["ideal"] in good:
            rows.setdefault((record["row"], record["driver"]), []).append((record, good[record["ideal"]]))
    return [min(pairs, key=_ratio) for pairs in rows.values()]


def _ratio(pair: tuple[Record, Record]) -> float:
    """As over_ideal, but also where the ideal did not get there."""
    record, ideal = pair
    return speed_mm_s(record, ideal) / max(speed_mm_s(ideal, None), 1e-9)


def draw(folder: Path, records: Sequence[Record]) -> None:
    """Draw one journey of each row and profile: that which differs most from its ideal."""
    for record, ideal in differs_most(records):
        draw_one(folder, f"{record['row']}-{record['driver'].replace(':', '-')}", record, ideal)


def draw_one(folder: Path, name: str, record: Record, ideal: Record) -> None:
    """Draw a journey beside its ideal."""
    mission = mission_of(parse_id(record["id"]))
    world = load_world(mission.world)
    start = mission.start[:2] if mission.start is not None else world.start[:2]
    course = np.array([start, *mission.course])
    near = np.vstack([course, record["path"], ideal["path"]])
    low, high = near.min(axis=0) - 2500.0, near.max(axis=0) + 2500.0
    left, bottom, right, top = world.bounds
    low, high = (
        np.maximum(low, (left - _MARGIN_MM, bottom - _MARGIN_MM)),
        np.minimum(high, (right + _MARGIN_MM, top + _MARGIN_MM)),
    )
    width, height = high - low
    inches = float(np.clip(_WIDTH_IN * height / width + 1.2, *_HEIGHT_IN))
    with picture(folder, name, (_WIDTH_IN, inches)) as figure:
        place = figure.subplots()
        place.add_collection(
            LineCollection(world.segments.reshape(-1, 2, 2).tolist(), colors="#222222", linewidths=1.2)
        )
        _ways(place, course, record, ideal)
        place.set(
            xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal", xlabel="x, mm", ylabel="y, mm"
        )
        place.set_title(_title(record, ideal), fontsize=9)
        place.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncol=4, fontsize=8, framealpha=0.9)


def _ways(place: Axes, course: Any, record: Record, ideal: Record) -> None:
    place.plot(*course.T, color="#bbbbbb", linestyle=":", linewidth=0.8, label="course")
    place.plot(
        *np.array(ideal["path"]).T,
        color=_IDEAL,
        linestyle="--",
        linewidth=1.2,
        label=f"ideal, {ideal['t_s']:.0f} s",
    )
    place.plot(
        *np.array(record["path"]).T,
        color=_DRIVEN,
        linewidth=1.2,
        label=f"{record['driver']}, {record['t_s']:.0f} s",
    )
    marks: Mapping[str, tuple[Sequence[Any], Mapping[str, Any]]] = {
        "stop": (record["stops_at"], {"marker": "s", "color": _STOP, "s": 14}),
        "look": (record["looks_at"], {"marker": "^", "color": _LOOK, "s": 22}),
        "collision": ([hit[1:] for hit in record["collisions"]], {"marker": "X", "color": _HIT, "s": 60}),
    }
    for name, (spots, style) in marks.items():
        if spots:
            place.scatter(*np.array(spots).T, zorder=3, label=f"{name} ({len(spots)})", **style)
    place.plot(*course[0], marker="o", color="#009E73", linestyle="none", label="start")
    place.plot(*course[-1], marker="*", color="#009E73", markersize=11, linestyle="none", label="goal")


def _title(record: Record, ideal: Record) -> str:
    away = f"{record['word']}, {record['goal_mm'] / 1000:.1f} m from the goal"
    arrived = "truly at the goal" if record["truly"] else away
    takes = f"{record['t_s']:.0f} s; {ideal['t_s']:.0f} s without fault and diagnosis"
    faults = f": {', '.join(map(_fault, record['faulty']))}" if record["faulty"] else ""
    return f"{parse_row(record['row']).says.capitalize()}{faults}\n{arrived} after {takes}"


def _fault(written: str) -> str:
    """Return a fault in words.

    >>> _fault("intermittent:5:p=0.8")
    'sonar 5 intermittent (p=0.8)'
    """
    kind, _, rest = written.partition(":")
    target, _, more = rest.partition(":")
    which = f"sonar {target}" if target.isdigit() else target.replace("-", " ")
    return " ".join(filter(None, [which, kind, f"({more.replace(':', ', ')})" if more else ""]))
