# SPDX-License-Identifier: MIT
"""The picture of a drive: a map of what happened where, the sonar ring as diagnosed, and a time line of both."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib as mpl
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from hil_sim.demo.ink import DPI, GREEN, INK, RED, SIZE_IN
from hil_sim.demo.map import draw_map, legend
from hil_sim.demo.panels import draw_ring, draw_time
from hil_sim.demo.scene import Drive


def _figures(drive: Drive) -> str:
    journey = drive.verdict.journey
    if journey is None:
        return ""
    closest = f"{journey.closest_mm:.0f} mm" if journey.closest_mm is not None else "-"
    rows = [
        f"{journey.time_s:.0f} s for {journey.way_mm / 1000:.1f} m",
        f"{journey.standstills} stops, {journey.sweeps} sweeps, {journey.turned_deg:.0f}° turned",
        f"{journey.energy_j['idle x 1']:.0f} J",
        f"never nearer than {closest} to anything",
    ]
    return "   |   ".join(rows)


def _headline(drive: Drive) -> tuple[str, str]:
    if drive.verdict.passed:
        return "Passed: goal reached, nothing hit, every fault found and no other", GREEN
    failed = ", ".join(rule.name for rule in drive.verdict.rules if not rule.holds)
    return f"Failed: {failed}", RED


def _write_line(figure: Figure, y: float, words: str, fontsize: float, **options: Any) -> None:
    """One line across the picture, in smaller letters when it would not fit."""
    text = figure.text(0.025, y, words, fontsize=fontsize, **options)
    room = 0.95 * figure.bbox.width
    wide = text.get_window_extent().width
    if wide > room:
        text.set_fontsize(fontsize * room / wide)


def draw(drive: Drive, path: Path) -> None:
    """Write the picture as a PNG file."""
    with mpl.rc_context({"font.family": "DejaVu Sans", "hatch.linewidth": 0.7, "hatch.color": "#b5b5b5"}):
        figure = Figure(figsize=SIZE_IN, dpi=DPI, facecolor="white")
        FigureCanvasAgg(figure)
        grid = figure.add_gridspec(
            2,
            2,
            left=0.02,
            right=0.985,
            top=0.83,
            bottom=0.115,
            width_ratios=(1.72, 1),
            height_ratios=(1.1, 1),
            wspace=0.1,
            hspace=0.22,
        )
        draw_map(figure.add_axes((0.02, 0.15, 0.60, 0.715)), drive)
        legend(figure.add_axes((0.025, 0.015, 0.60, 0.12)), drive)
        draw_ring(figure.add_subplot(grid[0, 1]), drive)
        draw_time(figure.add_subplot(grid[1, 1]), drive)
        headline, colour = _headline(drive)
        _write_line(figure, 0.955, drive.title, fontsize=18, fontweight="bold", color=INK)
        _write_line(figure, 0.92, headline, fontsize=13, fontweight="bold", color=colour)
        _write_line(figure, 0.885, _figures(drive), fontsize=11.5, color=INK)
        figure.savefig(path, dpi=DPI, metadata={"Software": None})
