# SPDX-License-Identifier: MIT
"""What went wrong where, written beside the map."""

from __future__ import annotations

import math

from matplotlib.axes import Axes
from matplotlib.patches import Wedge

from hil_sim.demo.ink import (
    FAULT_WORDS,
    INK,
    ORANGE,
    RED,
    ROBOT,
    ROOM_MM,
    SKY,
    body,
    draw_robot,
    place,
)
from hil_sim.demo.judge import Finding, of_type
from hil_sim.demo.scene import Drive, doubted_s, hits, window
from hil_sim.sonar.params import SonarParams


class Callouts:
    """Places boxes of text where they cover least of what is drawn already."""

    def __init__(self, axes: Axes, drive: Drive) -> None:
        self.axes = axes
        x1, y1, x2, y2 = window(drive)
        # The letters keep their size on paper, so in a larger window they take more of the floor.
        self.scale = max(1.0, (y2 - y1) / ROOM_MM)
        self.limits = (x1 + 60, y1 + 60, x2, y2 - 60)
        states = drive.states()[::3]
        self.busy = [(s["x_mm"], s["y_mm"], 3.0) for s in states]
        for finding in drive.verdict.findings:
            if finding.injected is not None:
                at = finding.injected
                self.busy += [(x, y, 40.0) for x, y in body(at.x_mm, at.y_mm, at.heading_deg)]
        for state in states[:1] + states[-1:]:  # where it starts and ends nothing hides it
            corners = body(state["x_mm"], state["y_mm"], state["heading_deg"])
            self.busy += [(x, y, 400.0) for x, y in [(state["x_mm"], state["y_mm"]), *corners]]
        self.busy += [(x, y, 0.25) for _, x, y, _ in list(hits(drive))[::2]]
        for ax, ay, bx, by in drive.world.segments:
            n = max(2, int(math.hypot(bx - ax, by - ay) / 80))
            self.busy += [(ax + (bx - ax) * i / n, ay + (by - ay) * i / n, 1.5) for i in range(n + 1)]
        self.taken: list[tuple[float, float, float, float]] = []

    def _cost(self, box: tuple[float, float, float, float], anchor: tuple[float, float]) -> float:
        cost = sum(weight for x, y, weight in self.busy if _overlap(box, (x, y, x, y), 45.0))
        cost += 500 * sum(_overlap(box, other, 50.0) for other in self.taken)
        x1, y1, x2, y2 = box
        low_x, low_y, high_x, high_y = self.limits
        cost += 1000 * any((x1 < low_x, y1 < low_y, x2 > high_x, y2 > high_y))
        return cost + math.hypot((x1 + x2) / 2 - anchor[0], (y1 + y2) / 2 - anchor[1]) / 150

    def put(self, x: float, y: float, text: str, colour: str, bold_head: bool = True) -> None:
        """Write a box that points at (x, y)."""
        lines = text.split("\n")
        width = self.scale * (42 * max(len(line) for line in lines) + 90)
        height = self.scale * (88 * len(lines) + 80)
        places = []
        for radius in (400, 550, 700, 900, 1150, 1450, 1800, 2200, 2600, 3000):
            for k in range(24):
                angle = 2 * math.pi * k / 24
                cx = x + (radius + width / 3) * math.cos(angle)
                cy = y + radius * math.sin(angle)
                places.append((cx - width / 2, cy - height / 2, cx + width / 2, cy + height / 2))
        best = min(places, key=lambda box: self._cost(box, (x, y)))
        self.taken.append(best)
        middle = ((best[0] + best[2]) / 2, (best[1] + best[3]) / 2)
        # The line is below all boxes: it crosses no text.
        line = {"arrowstyle": "-", "color": colour, "lw": 1.4, "shrinkA": 0, "shrinkB": 7}
        self.axes.annotate("", (x, y), middle, arrowprops=line, zorder=11.5)
        self.axes.text(
            *middle,
            text,
            ha="center",
            va="center",
            fontsize=10.5,
            color=INK,
            zorder=12,
            linespacing=1.25,
            fontweight="normal" if not bold_head else None,
            bbox={"boxstyle": "round,pad=0.4", "fc": "white", "ec": colour, "lw": 1.6},
        )


def _overlap(
    one: tuple[float, float, float, float], other: tuple[float, float, float, float], pad: float
) -> bool:
    """Whether two boxes are nearer than `pad` in both axes."""
    x1, y1, x2, y2 = one
    a1, b1, a2, b2 = other
    return x1 < a2 + pad and x2 > a1 - pad and y1 < b2 + pad and y2 > b1 - pad


def _draw_beam(axes: Axes, one: Finding) -> None:
    """Where the failing sonar looked when it failed."""
    if one.injected is None:
        return
    pose = ROBOT.mounts[one.fault.sonar]
    at = one.injected
    x, y = place(at.x_mm, at.y_mm, at.heading_deg, (pose.x_mm, pose.y_mm))
    axis, half = at.heading_deg + pose.heading_deg, SonarParams().cone_deg / 2
    axes.add_patch(Wedge((x, y), 520, axis - half, axis + half, facecolor=RED, alpha=0.2, lw=0, zorder=4.5))


def _fault_text(one: Finding, drive: Drive) -> str:
    """Tell when it came, when it was doubted, from which time on the robot relies on others, and when proved."""
    assert one.injected is not None
    came = one.injected.t_s
    lines = [f"Sonar {one.fault.sonar} {FAULT_WORDS.get(one.fault.kind, one.fault.kind)}"]
    lines.append(f"came at {came - drive.start_s:.1f} s")
    doubted = doubted_s(drive, one.fault.sonar, came)
    if doubted is not None:
        lines.append(f"doubted at {doubted - drive.start_s:.1f} s, {doubted - came:.1f} s later")
    if one.diagnosed is None:
        lines.append("never proved")
    else:
        lines.append(f"proved at {one.diagnosed.t_s - drive.start_s:.1f} s")
    return "\n".join(lines)


def _draw_doubt(axes: Axes, one: Finding, drive: Drive) -> None:
    """Mark where the robot was when it began to doubt the sonar."""
    doubted = None if one.injected is None else doubted_s(drive, one.fault.sonar, one.injected.t_s)
    if doubted is not None:
        at = min(drive.states(), key=lambda state: abs(state["t_s"] - doubted))
        axes.plot(at["x_mm"], at["y_mm"], "p", ms=10, mfc=ORANGE, mec=INK, mew=1.1, zorder=9.05)


def draw_faults(axes: Axes, drive: Drive, callouts: Callouts) -> None:
    """Draw where each fault began, and what became of it."""
    for one in drive.verdict.findings:
        if one.injected is None:
            continue
        at = one.injected
        draw_robot(axes, at.x_mm, at.y_mm, at.heading_deg, RED, 0.1)
        _draw_beam(axes, one)
        if one.diagnosed is not None:
            axes.plot(
                one.diagnosed.x_mm, one.diagnosed.y_mm, "D", ms=8.5, mfc=SKY, mec=INK, mew=1.1, zorder=9
            )
        axes.plot(at.x_mm, at.y_mm, "v", ms=11, mfc=RED, mec=INK, mew=1.1, zorder=9.1)
        _draw_doubt(axes, one, drive)
        callouts.put(at.x_mm, at.y_mm, _fault_text(one, drive), RED)


def draw_ends(axes: Axes, drive: Drive, callouts: Callouts) -> None:
    """Draw where the drive began and ended."""
    states = drive.states()
    for state, word in zip(states[:1] + states[-1:], ("Start", "Goal"), strict=False):
        draw_robot(axes, state["x_mm"], state["y_mm"], state["heading_deg"], INK, 0.08)
        text = word
        if word == "Goal":
            gx, gy = drive.course_mm[-1]
            off = math.hypot(state["x_mm"] - gx, state["y_mm"] - gy)
            text = f"Goal: robot stands {off:.0f} mm from it\nafter {drive.end_s - drive.start_s:.0f} s"
        callouts.put(state["x_mm"], state["y_mm"], text, INK)
    for record in of_type(drive.truth, "collision"):
        axes.plot(record["x_mm"], record["y_mm"], "X", ms=17, mfc=RED, mec=INK, zorder=11)
        callouts.put(
            record["x_mm"], record["y_mm"], f"Collision at {record['t_s'] - drive.start_s:.1f} s", RED
        )


def draw_false(axes: Axes, drive: Drive, callouts: Callouts) -> None:
    """Healthy sonars that were disabled: the drive failed there, and the reader should see where."""
    states = drive.states()
    for t_s, sonar, kind in drive.verdict.false_disables:
        state = min(states, key=lambda s: abs(s["t_s"] - t_s), default=None)
        if state is None:
            return
        axes.plot(state["x_mm"], state["y_mm"], "D", ms=8.5, mfc="white", mec=RED, mew=2, zorder=9)
        text = f"Sonar {sonar} is healthy, yet\ndisabled as {kind} at {t_s - drive.start_s:.1f} s"
        callouts.put(state["x_mm"], state["y_mm"], text, RED)
