# SPDX-License-Identifier: MIT
"""The map of a drive: the world, the way, what was heard and what went wrong where."""

from __future__ import annotations

import math
from typing import Any, Final

from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Polygon, Wedge

from hil_sim.demo.callouts import Callouts, draw_ends, draw_false, draw_faults
from hil_sim.demo.ink import (
    BLUE,
    FLOOR,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    place,
)
from hil_sim.demo.scene import Drive, area, doubted_s, failure_since_s, hits, loops, standstills, window
from hil_sim.world.model import World

SMOOTH: Final = 0.05
"""A surface below it mirrors sound: it is heard head-on only."""


def _draw_world(axes: Axes, world: World) -> None:
    outlines = sorted(loops(world), key=area, reverse=True)
    x1, y1, x2, y2 = world.bounds
    for points in outlines:
        room = area(points) > 0.5 * (x2 - x1) * (y2 - y1)
        face, hatch = (FLOOR, None) if room else ("#e4e4e4", "////")
        axes.add_patch(
            Polygon(
                points,
                facecolor=face,
                edgecolor=GREY if hatch else INK,
                hatch=hatch,
                lw=0,
                zorder=0 if room else 1,
            )
        )
    lines = [((a, b), (c, d)) for a, b, c, d in world.segments]
    axes.add_collection(LineCollection(lines, colors=INK, linewidths=2.2, capstyle="round", zorder=2))
    smooth = [line for line, rough in zip(lines, world.roughness, strict=True) if _is_smooth(rough)]
    axes.add_collection(LineCollection(smooth, colors=SKY, linewidths=5.0, capstyle="butt", zorder=1.9))


def _is_smooth(roughness: float) -> bool:
    return roughness < SMOOTH


def _draw_hits(axes: Axes, drive: Drive) -> None:
    good = [(x, y) for _, x, y, fault in hits(drive) if not fault]
    bad = [(x, y) for _, x, y, fault in hits(drive) if fault]
    if good:
        xs, ys = zip(*good, strict=True)
        axes.scatter(xs, ys, s=5, color=GREEN, alpha=0.35, lw=0, zorder=2.5)
    if bad:
        xs, ys = zip(*bad, strict=True)
        axes.scatter(xs, ys, s=16, color=PURPLE, marker="x", lw=0.9, alpha=0.75, zorder=2.6)


def _draw_path(axes: Axes, drive: Drive) -> None:
    since = failure_since_s(drive)
    states = drive.states()
    for colour, part in (
        (BLUE, [s for s in states if s["t_s"] <= since + 0.15]),
        (ORANGE, [s for s in states if s["t_s"] > since]),
    ):
        axes.plot(
            [s["x_mm"] for s in part],
            [s["y_mm"] for s in part],
            color="white",
            lw=6,
            zorder=6,
            solid_capstyle="round",
        )
        axes.plot(
            [s["x_mm"] for s in part],
            [s["y_mm"] for s in part],
            color=colour,
            lw=3.4,
            zorder=6.1,
            solid_capstyle="round",
        )


def _draw_stops(axes: Axes, drive: Drive) -> None:
    sweeps = [t_s for t_s, _ in drive.said("SWEEP")]
    for run in standstills(drive.states()):
        first, last = run[0], run[-1]
        x, y = last["x_mm"], last["y_mm"]
        if any(first["t_s"] <= t_s <= last["t_s"] + 0.5 for t_s in sweeps):
            base = last["heading_deg"]
            off = [math.remainder(state["heading_deg"] - base, 360) for state in run]
            low, high = min(off), max(off)
            axes.add_patch(
                Wedge((x, y), 260, base + low, base + high, facecolor=ORANGE, alpha=0.16, lw=0, zorder=4)
            )
            for edge in {round(low), 0, round(high)}:
                tip = place(x, y, base + edge, (260, 0))
                axes.plot([x, tip[0]], [y, tip[1]], color=ORANGE, lw=0.8, alpha=0.9, zorder=4.1)
        if len(run) > 2:
            axes.plot(x, y, "o", ms=5.2, mfc="white", mec=INK, mew=1.1, zorder=7)


def _draw_course(axes: Axes, drive: Drive) -> None:
    states = drive.states()
    points = [*((state["x_mm"], state["y_mm"]) for state in states[:1]), *drive.course_mm]
    axes.plot([x for x, _ in points], [y for _, y in points], color=GREY, lw=1.1, ls=(0, (2, 3)), zorder=3)
    for x, y in drive.course_mm[:-1]:
        axes.plot(x, y, "+", color=GREY, ms=9, mew=1.4, zorder=3)
    gx, gy = points[-1]
    axes.plot(gx, gy, marker="*", ms=21, mfc="white", mec=INK, mew=1.3, zorder=6.5)


def _draw_scale(axes: Axes, drive: Drive) -> None:
    x1, y1, _, _ = window(drive)
    x, y = x1 + 40, y1 - 170
    axes.plot([x, x + 1000], [y, y], color=INK, lw=2.4, solid_capstyle="butt", clip_on=False)
    for at in (x, x + 1000):
        axes.plot([at, at], [y - 35, y + 35], color=INK, lw=1.6, clip_on=False)
    axes.text(x + 1050, y, "1 m", va="center", fontsize=11, color=INK)


def draw_map(axes: Axes, drive: Drive) -> None:
    """Draw the map."""
    _draw_world(axes, drive.world)
    _draw_hits(axes, drive)
    _draw_course(axes, drive)
    _draw_path(axes, drive)
    _draw_stops(axes, drive)
    callouts = Callouts(axes, drive)
    draw_faults(axes, drive, callouts)
    draw_false(axes, drive, callouts)
    draw_ends(axes, drive, callouts)
    _draw_scale(axes, drive)
    x1, y1, x2, y2 = window(drive)
    axes.set_xlim(x1 - 60, x2 + 60)
    axes.set_ylim(y1 - 260, y2 + 60)
    axes.set_aspect("equal", anchor="NW")
    axes.axis("off")


def _is_doubted(drive: Drive) -> bool:
    """Whether a sonar is doubted after its fault came."""
    findings = [found for found in drive.verdict.findings if found.injected]
    return any(
        doubted_s(drive, found.fault.sonar, found.injected.t_s) is not None
        for found in findings
        if found.injected
    )


def legend(axes: Axes, drive: Drive) -> None:
    """Draw the legend of the map."""

    def dot(marker: str, face: str, edge: str, size: float, label: str) -> Line2D:
        return Line2D([], [], ls="", marker=marker, mfc=face, mec=edge, ms=size, mew=1.1, label=label)

    echoes = {bool(fault) for _, _, _, fault in hits(drive)}
    since = failure_since_s(drive)
    states, findings = drive.states(), drive.verdict.findings
    known: list[tuple[bool, Any]] = [
        (True, Line2D([], [], color=BLUE, lw=3.4, label="normal driving")),
        (
            any(state["t_s"] > since and abs(state["v_mm_s"]) > 50 for state in states),
            Line2D([], [], color=ORANGE, lw=3.4, label="failure mode: look, then step"),
        ),
        (
            len(drive.course_mm) > 1,
            Line2D([], [], color=GREY, lw=1.1, ls=(0, (2, 3)), marker="+", label="course given"),
        ),
        (any(len(run) > 2 for run in standstills(states)), dot("o", "white", INK, 6, "stop")),
        (
            bool(drive.said("SWEEP")),
            Patch(facecolor=ORANGE, alpha=0.3, label="sweep over the blind bearings"),
        ),
        (
            any(map(_is_smooth, drive.world.roughness)),
            Line2D([], [], color=SKY, lw=5.0, label="smooth, as glass: mirrors sound"),
        ),
        (any(f.injected for f in findings), dot("v", RED, INK, 10, "a fault comes (shaded: its beam)")),
        (_is_doubted(drive), dot("p", ORANGE, INK, 9, "it is doubted: others are relied on")),
        (any(f.diagnosed for f in findings), dot("D", SKY, INK, 8, "it is proved")),
        (False in echoes, dot(".", GREEN, GREEN, 7, "echo, healthy front sonar")),
        (True in echoes, dot("x", PURPLE, PURPLE, 6, "false echo, failed sonar")),
    ]
    entries = [entry for there, entry in known if there]
    axes.axis("off")
    axes.legend(
        handles=entries,
        loc="upper left",
        ncols=3,
        fontsize=10,
        frameon=False,
        columnspacing=1.4,
        handlelength=2.0,
        borderaxespad=0,
    )
