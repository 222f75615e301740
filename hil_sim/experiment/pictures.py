# SPDX-License-Identifier: MIT
"""The pictures of the experiments, as PNG, the same bytes each time."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.patches import Polygon, Wedge

from hil_sim.experiment.fig10 import DEAD, Drive, Stop
from hil_sim.experiment.plans import Plan
from hil_sim.tables.robot import robot_table

# Okabe and Ito's palette: told apart by colour-blind readers; in grey by marks and hatches.
COLOURS: Final[Mapping[str, str]] = {
    "paper": "#D55E00",
    "fewest": "#E69F00",
    "least-turn": "#56B4E9",
    "ring": "#009E73",
    "adaptive": "#0072B2",
}
_STYLE: Final[Any] = {"font.size": 9, "axes.grid": True, "grid.color": "#e4e4e4", "axes.axisbelow": True}
_CONE_DEG: Final = 15.0
_BEAM_MM: Final = 700.0
_FACE: Final = "#0072B2"


@contextmanager
def picture(path: Path, size: tuple[float, float]) -> Iterator[Figure]:
    """Give a figure and write it."""
    with rc_context(_STYLE):
        figure = Figure(figsize=size, layout="constrained")
        yield figure
        figure.savefig(path, dpi=110, metadata={"Software": None})


def draw_fig9(path: Path, plans: Mapping[str, Sequence[Plan]]) -> None:
    """Draw rotations and degrees for each of the 62 sets, the paper's walk beside the default policy."""
    with picture(path, (9.0, 13.5)) as figure:
        left, right = figure.subplots(1, 2, sharey=True)
        names = [plan.dead.replace("+", "") for plan in plans["paper"]]
        at = np.arange(len(names))
        shown = [name for name in ("paper", "fewest", "adaptive") if name in plans]
        width = 0.84 / len(shown)
        for k, policy in enumerate(shown):
            off = (k - (len(shown) - 1) / 2) * width
            counts = [len(plan.rotations) for plan in plans[policy]]
            degrees = [plan.turned_deg for plan in plans[policy]]
            label = f"{policy}: {sum(counts)} rotations, {sum(degrees)} degrees"
            left.barh(at + off, counts, width, color=COLOURS[policy], label=label)
            right.barh(at + off, degrees, width, color=COLOURS[policy])
        left.set_xlabel("rotations at each stop")
        right.set_xlabel("degrees turned at each stop")
        left.set_yticks(at, [" ".join(name) for name in names], fontsize=9)
        left.set_ylabel("dead sonars of 1 to 6")
        left.set_ylim(len(names) - 0.2, -0.8)
        for place in (left, right):
            place.grid(axis="y", visible=False)
        left.legend(loc="upper right", fontsize=9)
        figure.suptitle("What covering for dead sonars takes at each stop, all 62 sets", fontsize=11)


def draw_fig10(path: Path, drive: Drive) -> None:
    """Draw the stop drive: where the robot stood, and where it looked from there."""
    with picture(path, (10.0, 6.2)) as figure:
        place = figure.subplots()
        walls = np.array(drive.walls).reshape(-1, 2, 2)
        place.add_collection(LineCollection(walls.tolist(), colors="#222222", linewidths=1.4))
        for stop in drive.stops:
            _draw_stop(place, stop)
        path_xy = np.array([state[1:3] for state in drive.seen.states])
        place.plot(*path_xy.T, color="#444444", linewidth=1.2, label="way of the centre")
        spots = np.array([(stop.x_mm, stop.y_mm) for stop in drive.stops])
        label = f"stop ({len(spots)})"
        place.scatter(spots[:, 0], spots[:, 1], marker="s", s=22, color="#E69F00", zorder=4, label=label)
        place.add_patch(
            Wedge((0, 0), 0, 0, 1, color=_FACE, alpha=0.25, label="looked along the blind bearing")
        )
        low, high = walls.reshape(-1, 2).min(axis=0) - 100, walls.reshape(-1, 2).max(axis=0) + 100
        place.set(
            xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal", xlabel="x, mm", ylabel="y, mm"
        )
        found = drive.seen.values("OBJECT_CHECKED")
        end = f"the post is found in a turn, at {found[0]} mm" if found else "nothing is found in a turn"
        place.set_title(
            f"Sonar {DEAD} dead, profile paper: a stop each 200 mm, a turn at each; {end}", fontsize=10
        )
        figure.legend(loc="outside lower center", ncols=3, fontsize=8)


def _draw_stop(place: Axes, stop: Stop) -> None:
    table = robot_table()
    heading = math.radians(stop.heading_deg)
    c, s = math.cos(heading), math.sin(heading)
    corners = [(stop.x_mm + x * c - y * s, stop.y_mm + x * s + y * c) for x, y in table.body.corners]
    place.add_patch(Polygon(corners, closed=True, fill=False, edgecolor="#bbbbbb", linewidth=0.7))
    if not stop.looks_deg:
        return
    mount = table.mounts[DEAD]
    x = stop.x_mm + mount.x_mm * c - mount.y_mm * s
    y = stop.y_mm + mount.x_mm * s + mount.y_mm * c
    axis = stop.heading_deg + mount.heading_deg
    place.add_patch(
        Wedge((x, y), _BEAM_MM, axis - _CONE_DEG, axis + _CONE_DEG, color=_FACE, alpha=0.13, linewidth=0)
    )
