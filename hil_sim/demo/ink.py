# SPDX-License-Identifier: MIT
"""Colours, sizes and words of the picture."""

from __future__ import annotations

import math
from typing import Any, Final

from matplotlib import patheffects
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon

from hil_sim.tables.robot import robot_table

# Okabe and Ito's palette: told apart by colour-blind readers too. Every colour is doubled by a shape or a word.
BLUE, ORANGE, GREEN, RED, PURPLE, SKY = "#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9"
INK, GREY, PALE, FLOOR = "#222222", "#8a8a8a", "#d5d5d5", "#fafafa"
SIZE_IN: Final = (16.0, 10.0)
DPI: Final = 100
ROBOT: Final = robot_table()
FRONT: Final = ROBOT.forward
ABOUT_MM: Final = 2500.0
ROOM_MM: Final = 4000.0
MARGIN_MM: Final = 1500.0
"""Room for words to the right of the map."""
FAULT_WORDS: Final = {
    "off": "goes dead:\nit reads 5000 from here on",
    "wrong": "goes wrong:\nit reads half the range from here on",
    "silent": "falls silent:\nno reading from here on",
}


def body(x_mm: float, y_mm: float, heading_deg: float) -> list[tuple[float, float]]:
    """Return the corners of the robot in the world."""
    shape = ROBOT.body
    half, nose = shape.half_mm, shape.front_mm
    corners = [(nose, half * 0.5), (nose * 0.55, half), (-shape.rear_mm, half)]
    corners += [(x, -y) for x, y in reversed(corners)]
    return [place(x_mm, y_mm, heading_deg, corner) for corner in corners]


def place(x_mm: float, y_mm: float, heading_deg: float, at: tuple[float, float]) -> tuple[float, float]:
    """Return a point of the robot in the world."""
    c, s = math.cos(math.radians(heading_deg)), math.sin(math.radians(heading_deg))
    return x_mm + at[0] * c - at[1] * s, y_mm + at[0] * s + at[1] * c


def draw_robot(
    axes: Axes, x_mm: float, y_mm: float, heading_deg: float, colour: str, fill: float = 0.12
) -> None:
    """Draw the robot at a pose."""
    points = body(x_mm, y_mm, heading_deg)
    axes.add_patch(Polygon(points, facecolor=colour, alpha=fill, lw=0, zorder=3))
    axes.add_patch(Polygon(points, facecolor="none", edgecolor=colour, lw=1.2, zorder=5))
    nose = [place(x_mm, y_mm, heading_deg, at) for at in ((90, 60), (160, 0), (90, -60))]
    axes.add_line(Line2D([x for x, _ in nose], [y for _, y in nose], color=colour, lw=1.2, zorder=5))


def _outlined(axes: Axes, x: float, y: float, text: str, **options: Any) -> None:
    axes.text(x, y, text, path_effects=[patheffects.withStroke(linewidth=3, foreground="white")], **options)
