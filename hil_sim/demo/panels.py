# SPDX-License-Identifier: MIT
"""The sonar ring as diagnosed, and the time line of a drive."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.patches import Patch, Polygon, Wedge

from hil_sim.demo.ink import BLUE, FRONT, GREEN, INK, ORANGE, PALE, RED, ROBOT, SKY, body, place
from hil_sim.demo.scene import Drive, doubted_s, health_spans, robot_spans


def draw_ring(axes: Axes, drive: Drive) -> None:
    """Draw the sonar ring as diagnosed."""
    kinds = {one.fault.sonar: one.diagnosed_kind for one in drive.verdict.findings if one.diagnosed_kind}
    kinds |= {sonar: kind for _, sonar, kind in drive.verdict.false_disables}
    points = body(0, 0, 90)
    axes.add_patch(Polygon(points, facecolor="#eeeeee", edgecolor=INK, lw=1.4))
    for number in range(ROBOT.sonars):
        _draw_sonar(axes, number, bad=number in kinds)
    axes.text(0, -30, ROBOT.subclass, ha="center", va="center", fontsize=10, color=INK)
    verdicts = (
        ", ".join(f"sonar {number}: {kind}" for number, kind in sorted(kinds.items())) or "no sonar disabled"
    )
    axes.set_title(f"What Argus knows at the end\n{verdicts}", fontsize=12, loc="left", color=INK)
    axes.set_xlim(-760, 760)
    axes.set_ylim(-640, 760)
    axes.set_aspect("equal")
    axes.axis("off")


def _draw_sonar(axes: Axes, number: int, *, bad: bool) -> None:
    """Draw where one sonar looks, and whether it is known to be bad; the forward-facing six are longer."""
    pose, forward = ROBOT.mounts[number], number in FRONT
    heading = pose.heading_deg + 90
    c, s = math.cos(math.radians(heading)), math.sin(math.radians(heading))
    x, y = place(0, 0, 90, (pose.x_mm, pose.y_mm))
    reach = 430 if forward else 240
    colour = GREEN if forward else PALE
    axes.add_patch(
        Wedge(
            (x, y),
            reach,
            heading - 9,
            heading + 9,
            facecolor=RED if bad else colour,
            alpha=0.75 if bad else 0.4,
            lw=0,
        )
    )
    axes.text(
        x + (reach + 75) * c,
        y + (reach + 75) * s,
        str(number),
        ha="center",
        va="center",
        fontsize=10.5,
        fontweight="bold" if bad else "normal",
        color=RED if bad else INK,
    )
    if bad:
        axes.plot(x + 225 * c, y + 225 * s, "x", ms=9, mew=2.6, color="white")


def _bar(
    axes: Axes,
    row: float,
    spans: Sequence[tuple[float, float, str]],
    start_s: float,
    looks: dict[str, tuple[str, str]],
) -> None:
    for since, until, word in spans:
        colour, hatch = looks[word]
        axes.barh(
            row,
            until - since,
            left=since - start_s,
            height=0.62,
            color=colour,
            hatch=hatch,
            edgecolor="white",
            lw=0,
        )


def draw_time(axes: Axes, drive: Drive) -> None:
    """Draw the time line."""
    looks = {
        "unknown": ("#eeeeee", ""),
        "healthy": ("#8fd3bd", ""),
        "suspect": (ORANGE, ""),
        "disabled": (RED, "///"),
    }
    doing = {"drive": (BLUE, ""), "turn": (SKY, ""), "stand": ("#e6e6e6", "")}
    for number in FRONT:
        _bar(axes, number, health_spans(drive, number), drive.start_s, looks)
    _bar(axes, 7.25, list(robot_spans(drive)), drive.start_s, doing)
    for one in drive.verdict.findings:
        if one.injected:
            axes.plot(
                one.injected.t_s - drive.start_s,
                one.fault.sonar - 0.52,
                "v",
                ms=8,
                mfc=RED,
                mec=INK,
                clip_on=False,
                zorder=5,
            )
            doubted = doubted_s(drive, one.fault.sonar, one.injected.t_s)
            if doubted is not None:
                at = doubted - drive.start_s
                axes.plot(at, one.fault.sonar, "p", ms=8, mfc="white", mec=INK, zorder=5)
                axes.text(
                    at + 0.4,
                    one.fault.sonar,
                    f"doubted after {doubted - one.injected.t_s:.1f} s",
                    va="center",
                    fontsize=9.5,
                    fontweight="bold",
                    color=INK,
                    zorder=6,
                )
        if one.diagnosed:
            axes.plot(
                one.diagnosed.t_s - drive.start_s, one.fault.sonar, "D", ms=6.5, mfc=SKY, mec=INK, zorder=5
            )
    axes.set_yticks([*FRONT, 7.25], [*(f"sonar {number}" for number in FRONT), "robot"], fontsize=10.5)
    axes.set_ylim(7.75, 0.2)
    axes.set_xlim(0, max(drive.end_s - drive.start_s, 1.0))
    axes.set_xlabel("seconds since the session opened", fontsize=10.5)
    axes.set_title("What Argus held of each sonar, when", fontsize=12, loc="left", color=INK)
    axes.tick_params(axis="y", length=0)
    for side in ("top", "right", "left"):
        axes.spines[side].set_visible(False)
    words = [("healthy", looks["healthy"]), ("suspect", looks["suspect"]), ("disabled", looks["disabled"])]
    words += [("drives", doing["drive"]), ("turns", doing["turn"]), ("stands", doing["stand"])]
    handles = [
        Patch(facecolor=colour, hatch=hatch, edgecolor="white", label=word) for word, (colour, hatch) in words
    ]
    axes.legend(
        handles=handles,
        loc="upper left",
        bbox_to_anchor=(-0.02, -0.14),
        ncols=6,
        fontsize=9.5,
        frameon=False,
        handlelength=1.2,
        columnspacing=1.0,
        handletextpad=0.5,
    )
