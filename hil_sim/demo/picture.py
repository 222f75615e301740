# SPDX-License-Identifier: MIT
"""The picture of a drive: a map of what happened where, the sonar ring as diagnosed, and a time line of both."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import matplotlib as mpl
from matplotlib import patheffects
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Polygon, Wedge

from hil_sim.demo.judge import Finding, Record, Verdict, of_type, sonar_of
from hil_sim.tables import load
from hil_sim.world import World

# Okabe and Ito's palette: told apart by colour-blind readers too. Every colour is doubled by a shape or a word.
_BLUE, _ORANGE, _GREEN, _RED, _PURPLE, _SKY = "#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9"
_INK, _GREY, _PALE, _FLOOR = "#222222", "#8a8a8a", "#d5d5d5", "#fafafa"

_SIZE_IN: Final = (16.0, 10.0)
_DPI: Final = 100
_FRONT: Final = range(1, 7)
_ABOUT_MM: Final = 2500.0
_ROOM_MM: Final = 4000.0
_MARGIN_MM: Final = 1500.0
"""Room for words to the right of the map."""
_STANDS_MM_S: Final = 5.0
_P3DX: Final = load("robots/p3dx-sh")
_POSE: Final = {int(pose["number"]): pose for pose in _P3DX["sonar"]["pose"]}
_NO_ECHO_MM: Final = float(_P3DX["sonar"]["no_echo_mm"])
_FAULT_WORDS: Final = {
    "off": "goes dead:\nit reads 5000 from here on",
    "wrong": "lies from here on:\nit reads half the truth",
    "silent": "falls silent:\nno reading from here on",
}


@dataclass(frozen=True)
class Drive:
    """What there is to draw; times of `events` are argusd's, `offset_s` makes them robot time."""

    world: World
    course_mm: Sequence[tuple[float, float]]
    truth: Sequence[Record]
    events: Sequence[Record]
    verdict: Verdict
    offset_s: float
    title: str

    @property
    def start_s(self) -> float:
        """Robot time at which the session opened."""
        return self.verdict.journey.start_s if self.verdict.journey else 0.0

    @property
    def end_s(self) -> float:
        """Robot time at which the journey ended."""
        return self.verdict.journey.end_s if self.verdict.journey else 0.0

    def states(self) -> list[Record]:
        """True states of the journey."""
        return [state for state in of_type(self.truth, "state") if self.start_s <= state["t_s"] <= self.end_s]

    def said(self, *names: str) -> list[tuple[float, Record]]:
        """Events of these names with robot times."""
        return [(e["t"] + self.offset_s, e) for e in self.events if e.get("event") in names]


# ---- the map -----------------------------------------------------------------------------------------------


def loops(world: World) -> Iterator[list[tuple[float, float]]]:
    """Closed outlines among consecutive segments of a world: rooms, boxes, posts."""
    chain: list[tuple[float, float]] = []
    for x1, y1, x2, y2 in world.segments:
        if not chain or chain[-1] != (x1, y1):
            chain = [(x1, y1)]
        chain.append((x2, y2))
        if chain[0] == chain[-1]:
            yield chain[:-1]
            chain = []


def _area(points: Sequence[tuple[float, float]]) -> float:
    shifted = [*points[1:], points[0]]
    return abs(sum(x1 * y2 - x2 * y1 for (x1, y1), (x2, y2) in zip(points, shifted, strict=True))) / 2


def _draw_world(axes: Axes, world: World) -> None:
    outlines = sorted(loops(world), key=_area, reverse=True)
    x1, y1, x2, y2 = world.bounds
    for points in outlines:
        room = _area(points) > 0.5 * (x2 - x1) * (y2 - y1)
        face, hatch = (_FLOOR, None) if room else ("#e4e4e4", "////")
        axes.add_patch(
            Polygon(
                points,
                facecolor=face,
                edgecolor=_GREY if hatch else _INK,
                hatch=hatch,
                lw=0,
                zorder=0 if room else 1,
            )
        )
    lines = [((a, b), (c, d)) for a, b, c, d in world.segments]
    axes.add_collection(LineCollection(lines, colors=_INK, linewidths=2.2, capstyle="round", zorder=2))


def _body(x_mm: float, y_mm: float, heading_deg: float) -> list[tuple[float, float]]:
    body = _P3DX["body"]
    half = body["width_mm"] / 2
    nose = body["front_mm"]
    corners = [(nose, half * 0.5), (nose * 0.55, half), (-body["rear_mm"], half)]
    corners += [(x, -y) for x, y in reversed(corners)]
    return [_place(x_mm, y_mm, heading_deg, corner) for corner in corners]


def _place(x_mm: float, y_mm: float, heading_deg: float, at: tuple[float, float]) -> tuple[float, float]:
    c, s = math.cos(math.radians(heading_deg)), math.sin(math.radians(heading_deg))
    return x_mm + at[0] * c - at[1] * s, y_mm + at[0] * s + at[1] * c


def _draw_robot(
    axes: Axes, x_mm: float, y_mm: float, heading_deg: float, colour: str, fill: float = 0.12
) -> None:
    points = _body(x_mm, y_mm, heading_deg)
    axes.add_patch(Polygon(points, facecolor=colour, alpha=fill, lw=0, zorder=3))
    axes.add_patch(Polygon(points, facecolor="none", edgecolor=colour, lw=1.2, zorder=5))
    nose = [_place(x_mm, y_mm, heading_deg, at) for at in ((90, 60), (160, 0), (90, -60))]
    axes.add_line(Line2D([x for x, _ in nose], [y for _, y in nose], color=colour, lw=1.2, zorder=5))


def hits(drive: Drive) -> Iterator[tuple[int, float, float, str | None]]:
    """Sonar number, place of the reported echo, and the fault that made it, for every echo of sonars 1 to 6."""
    states = drive.states()
    k = 0
    for record in of_type(drive.truth, "sonar"):
        if not drive.start_s <= record["t_s"] <= drive.end_s or record["range_mm"] >= _NO_ECHO_MM:
            continue
        while k + 1 < len(states) and states[k + 1]["t_s"] <= record["t_s"]:
            k += 1
        pose = _POSE[record["sonar"]]
        axis = math.radians(pose["heading_deg"])
        reach = record["range_mm"]
        echo = (pose["x_mm"] + reach * math.cos(axis), pose["y_mm"] + reach * math.sin(axis))
        state = states[k]
        x, y = _place(state["x_mm"], state["y_mm"], state["heading_deg"], echo)
        if record["sonar"] in _FRONT:
            yield record["sonar"], x, y, record.get("fault")


def _draw_hits(axes: Axes, drive: Drive) -> None:
    good = [(x, y) for _, x, y, fault in hits(drive) if not fault]
    bad = [(x, y) for _, x, y, fault in hits(drive) if fault]
    if good:
        axes.scatter(
            [x for x, _ in good], [y for _, y in good], s=5, color=_GREEN, alpha=0.35, lw=0, zorder=2.5
        )
    if bad:
        axes.scatter(
            [x for x, _ in bad],
            [y for _, y in bad],
            s=16,
            color=_PURPLE,
            marker="x",
            lw=0.9,
            alpha=0.75,
            zorder=2.6,
        )


def _failure_since_s(drive: Drive) -> float:
    """When the first plan was made: from then on the robot drives in steps."""
    planned = (
        [plan.t_s for plan in drive.verdict.journey.plans if plan.rotations_deg]
        if drive.verdict.journey
        else []
    )
    return min(planned, default=math.inf)


def _draw_path(axes: Axes, drive: Drive) -> None:
    since = _failure_since_s(drive)
    states = drive.states()
    for colour, part in (
        (_BLUE, [s for s in states if s["t_s"] <= since + 0.15]),
        (_ORANGE, [s for s in states if s["t_s"] > since]),
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


def standstills(states: Sequence[Record]) -> Iterator[list[Record]]:
    """Runs of states during which the robot did not translate."""
    run: list[Record] = []
    for state in states:
        if abs(state["v_mm_s"]) <= _STANDS_MM_S:
            run.append(state)
        elif run:
            yield run
            run = []
    if run:
        yield run


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
                Wedge((x, y), 260, base + low, base + high, facecolor=_ORANGE, alpha=0.16, lw=0, zorder=4)
            )
            for edge in {round(low), 0, round(high)}:
                tip = _place(x, y, base + edge, (260, 0))
                axes.plot([x, tip[0]], [y, tip[1]], color=_ORANGE, lw=0.8, alpha=0.9, zorder=4.1)
        if len(run) > 2:
            axes.plot(x, y, "o", ms=5.2, mfc="white", mec=_INK, mew=1.1, zorder=7)


def _outlined(axes: Axes, x: float, y: float, text: str, **options: Any) -> None:
    axes.text(x, y, text, path_effects=[patheffects.withStroke(linewidth=3, foreground="white")], **options)


def _draw_course(axes: Axes, drive: Drive) -> None:
    states = drive.states()
    points = [*((state["x_mm"], state["y_mm"]) for state in states[:1]), *drive.course_mm]
    axes.plot([x for x, _ in points], [y for _, y in points], color=_GREY, lw=1.1, ls=(0, (2, 3)), zorder=3)
    for x, y in drive.course_mm[:-1]:
        axes.plot(x, y, "+", color=_GREY, ms=9, mew=1.4, zorder=3)
    gx, gy = points[-1]
    axes.plot(gx, gy, marker="*", ms=21, mfc="white", mec=_INK, mew=1.3, zorder=6.5)


def _window(drive: Drive) -> tuple[float, float, float, float]:
    """What the map shows: the whole of a room and some paper beside it, of a larger world what lies about the way."""
    states = drive.states() or [{"x_mm": 0.0, "y_mm": 0.0}]
    xs, ys = [s["x_mm"] for s in states], [s["y_mm"] for s in states]
    x1, y1, x2, y2 = drive.world.bounds
    return (
        max(x1, min(xs) - _ABOUT_MM),
        max(y1, min(ys) - _ABOUT_MM),
        min(x2 + _MARGIN_MM, max(xs) + _ABOUT_MM),
        min(y2, max(ys) + _ABOUT_MM),
    )


def _draw_scale(axes: Axes, drive: Drive) -> None:
    x1, y1, _, _ = _window(drive)
    x, y = x1 + 40, y1 - 170
    axes.plot([x, x + 1000], [y, y], color=_INK, lw=2.4, solid_capstyle="butt", clip_on=False)
    for at in (x, x + 1000):
        axes.plot([at, at], [y - 35, y + 35], color=_INK, lw=1.6, clip_on=False)
    axes.text(x + 1050, y, "1 m", va="center", fontsize=11, color=_INK)


class _Callouts:
    """Places boxes of text where they cover least of what is drawn already."""

    def __init__(self, axes: Axes, drive: Drive) -> None:
        self.axes = axes
        x1, y1, x2, y2 = _window(drive)
        # The letters keep their size on paper, so in a larger window they take more of the floor.
        self.scale = max(1.0, (y2 - y1) / _ROOM_MM)
        self.limits = (x1 + 60, y1 + 60, x2, y2 - 60)
        states = drive.states()[::3]
        self.busy = [(s["x_mm"], s["y_mm"], 3.0) for s in states]
        for finding in drive.verdict.findings:
            if finding.injected is not None:
                at = finding.injected
                self.busy += [(x, y, 40.0) for x, y in _body(at.x_mm, at.y_mm, at.heading_deg)]
        self.busy += [(x, y, 0.25) for _, x, y, _ in list(hits(drive))[::2]]
        for ax, ay, bx, by in drive.world.segments:
            n = max(2, int(math.hypot(bx - ax, by - ay) / 80))
            self.busy += [(ax + (bx - ax) * i / n, ay + (by - ay) * i / n, 1.5) for i in range(n + 1)]
        self.taken: list[tuple[float, float, float, float]] = []

    def _cost(self, box: tuple[float, float, float, float], anchor: tuple[float, float]) -> float:
        x1, y1, x2, y2 = box
        pad = 45.0
        cost = sum(
            weight for x, y, weight in self.busy if x1 - pad < x < x2 + pad and y1 - pad < y < y2 + pad
        )
        cost += sum(
            500
            for a1, b1, a2, b2 in self.taken
            if x1 < a2 + 50 and x2 > a1 - 50 and y1 < b2 + 50 and y2 > b1 - 50
        )
        low_x, low_y, high_x, high_y = self.limits
        cost += 1000 * (x1 < low_x or y1 < low_y or x2 > high_x or y2 > high_y)
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
        self.axes.annotate(
            text,
            (x, y),
            ((best[0] + best[2]) / 2, (best[1] + best[3]) / 2),
            ha="center",
            va="center",
            fontsize=10.5,
            color=_INK,
            zorder=12,
            linespacing=1.25,
            fontweight="normal" if not bold_head else None,
            bbox={"boxstyle": "round,pad=0.4", "fc": "white", "ec": colour, "lw": 1.6},
            arrowprops={"arrowstyle": "-", "color": colour, "lw": 1.4, "shrinkB": 7},
        )


def _draw_beam(axes: Axes, one: Finding) -> None:
    """Where the failing sonar looked when it failed."""
    if one.injected is None:
        return
    pose = _POSE[one.fault.sonar]
    at = one.injected
    x, y = _place(at.x_mm, at.y_mm, at.heading_deg, (pose["x_mm"], pose["y_mm"]))
    axis, half = at.heading_deg + pose["heading_deg"], _P3DX["sonar"]["cone_deg"] / 2
    axes.add_patch(Wedge((x, y), 520, axis - half, axis + half, facecolor=_RED, alpha=0.2, lw=0, zorder=4.5))


def _fault_text(one: Finding, start_s: float) -> str:
    assert one.injected is not None
    lines = [f"Sonar {one.fault.sonar} {_FAULT_WORDS.get(one.fault.kind, one.fault.kind)}"]
    lines.append(f"came at {one.injected.t_s - start_s:.1f} s")
    if one.diagnosed is None:
        lines[-1] += ", never found"
    else:
        lines.append(f"found at {one.diagnosed.t_s - start_s:.1f} s")
        if one.latency_s is not None:
            lines[-1] += f", {one.latency_s:.1f} s after\nits first false reading"
    return "\n".join(lines)


def _draw_faults(axes: Axes, drive: Drive, callouts: _Callouts) -> None:
    for one in drive.verdict.findings:
        if one.injected is None:
            continue
        at = one.injected
        _draw_robot(axes, at.x_mm, at.y_mm, at.heading_deg, _RED, 0.1)
        _draw_beam(axes, one)
        if one.diagnosed is not None:
            axes.plot(
                one.diagnosed.x_mm, one.diagnosed.y_mm, "D", ms=8.5, mfc=_SKY, mec=_INK, mew=1.1, zorder=9
            )
        axes.plot(at.x_mm, at.y_mm, "v", ms=11, mfc=_RED, mec=_INK, mew=1.1, zorder=9.1)
        callouts.put(at.x_mm, at.y_mm, _fault_text(one, drive.start_s), _RED)


def _draw_ends(axes: Axes, drive: Drive, callouts: _Callouts) -> None:
    states = drive.states()
    for state, word in zip(states[:1] + states[-1:], ("Start", "Goal"), strict=False):
        _draw_robot(axes, state["x_mm"], state["y_mm"], state["heading_deg"], _INK, 0.08)
        text = word
        if word == "Goal":
            gx, gy = drive.course_mm[-1]
            off = math.hypot(state["x_mm"] - gx, state["y_mm"] - gy)
            text = f"Goal: robot stands {off:.0f} mm from it\nafter {drive.end_s - drive.start_s:.0f} s"
        callouts.put(state["x_mm"], state["y_mm"], text, _INK)
    for record in of_type(drive.truth, "collision"):
        axes.plot(record["x_mm"], record["y_mm"], "X", ms=17, mfc=_RED, mec=_INK, zorder=11)
        callouts.put(
            record["x_mm"], record["y_mm"], f"Collision at {record['t_s'] - drive.start_s:.1f} s", _RED
        )


def _draw_false(axes: Axes, drive: Drive, callouts: _Callouts) -> None:
    """Healthy sonars that were disabled: the drive failed there, and the reader should see where."""
    states = drive.states()
    for t_s, sonar, kind in drive.verdict.false_disables:
        state = min(states, key=lambda s: abs(s["t_s"] - t_s), default=None)
        if state is None:
            return
        axes.plot(state["x_mm"], state["y_mm"], "D", ms=8.5, mfc="white", mec=_RED, mew=2, zorder=9)
        text = f"Sonar {sonar} is healthy, yet\ndisabled as {kind} at {t_s - drive.start_s:.1f} s"
        callouts.put(state["x_mm"], state["y_mm"], text, _RED)


def _draw_map(axes: Axes, drive: Drive) -> None:
    _draw_world(axes, drive.world)
    _draw_hits(axes, drive)
    _draw_course(axes, drive)
    _draw_path(axes, drive)
    _draw_stops(axes, drive)
    callouts = _Callouts(axes, drive)
    _draw_faults(axes, drive, callouts)
    _draw_false(axes, drive, callouts)
    _draw_ends(axes, drive, callouts)
    _draw_scale(axes, drive)
    x1, y1, x2, y2 = _window(drive)
    axes.set_xlim(x1 - 60, x2 + 60)
    axes.set_ylim(y1 - 260, y2 + 60)
    axes.set_aspect("equal", anchor="NW")
    axes.axis("off")


def _legend(axes: Axes, drive: Drive) -> None:
    def dot(marker: str, face: str, edge: str, size: float, label: str) -> Line2D:
        return Line2D([], [], ls="", marker=marker, mfc=face, mec=edge, ms=size, mew=1.1, label=label)

    false = any(fault for _, _, _, fault in hits(drive))
    entries: list[Any] = [
        Line2D([], [], color=_BLUE, lw=3.4, label="normal driving"),
        Line2D([], [], color=_ORANGE, lw=3.4, label="failure mode: look, then step"),
        Line2D([], [], color=_GREY, lw=1.1, ls=(0, (2, 3)), marker="+", label="course given"),
        dot("o", "white", _INK, 6, "stop"),
        Patch(facecolor=_ORANGE, alpha=0.3, label="sweep over the blind bearings"),
        dot("v", _RED, _INK, 10, "a fault comes (shaded: its beam)"),
        dot("D", _SKY, _INK, 8, "Argus has found it"),
        dot(".", _GREEN, _GREEN, 7, "echo, healthy front sonar"),
    ]
    if false:
        entries.append(dot("x", _PURPLE, _PURPLE, 6, "false echo, lying sonar"))
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


# ---- the ring and the time line ----------------------------------------------------------------------------


def _draw_ring(axes: Axes, drive: Drive) -> None:
    kinds = {one.fault.sonar: one.diagnosed_kind for one in drive.verdict.findings if one.diagnosed_kind}
    kinds |= {sonar: kind for _, sonar, kind in drive.verdict.false_disables}
    points = _body(0, 0, 90)
    axes.add_patch(Polygon(points, facecolor="#eeeeee", edgecolor=_INK, lw=1.4))
    for number, pose in _POSE.items():
        heading = pose["heading_deg"] + 90
        x, y = _place(0, 0, 90, (pose["x_mm"], pose["y_mm"]))
        bad = kinds.get(number)
        reach = 430 if number in _FRONT else 240
        colour = _RED if bad else (_GREEN if number in _FRONT else _PALE)
        axes.add_patch(
            Wedge((x, y), reach, heading - 9, heading + 9, facecolor=colour, alpha=0.75 if bad else 0.4, lw=0)
        )
        tx, ty = (
            x + (reach + 75) * math.cos(math.radians(heading)),
            y + (reach + 75) * math.sin(math.radians(heading)),
        )
        weight = "bold" if bad else "normal"
        axes.text(
            tx,
            ty,
            str(number),
            ha="center",
            va="center",
            fontsize=10.5,
            fontweight=weight,
            color=_RED if bad else _INK,
        )
        if bad:
            wx, wy = x + 225 * math.cos(math.radians(heading)), y + 225 * math.sin(math.radians(heading))
            axes.plot(wx, wy, "x", ms=9, mew=2.6, color="white")
    axes.text(0, -30, "P3-DX", ha="center", va="center", fontsize=10, color=_INK)
    verdicts = (
        ", ".join(f"sonar {number}: {kind}" for number, kind in sorted(kinds.items())) or "no sonar disabled"
    )
    axes.set_title(f"What Argus knows at the end\n{verdicts}", fontsize=12, loc="left", color=_INK)
    axes.set_xlim(-760, 760)
    axes.set_ylim(-640, 760)
    axes.set_aspect("equal")
    axes.axis("off")


def health_spans(drive: Drive, sonar: int) -> list[tuple[float, float, str]]:
    """What argusd held of a sonar: from, to, one of healthy, suspect, disabled."""
    word = {"SONAR_SUSPECT": "suspect", "SONAR_CLEARED": "healthy", "SUSPICION_DROPPED": "healthy"}
    word |= {"SONAR_HEALTHY": "healthy", "SONAR_DISABLED": "disabled"}
    spans: list[tuple[float, float, str]] = []
    since, now = drive.start_s, "unknown"
    for t_s, event in drive.said(*word):
        if sonar_of(event) == sonar and word[event["event"]] != now:
            spans.append((since, t_s, now))
            since, now = t_s, word[event["event"]]
    return [*spans, (since, drive.end_s, now)]


def _robot_spans(drive: Drive) -> Iterator[tuple[float, float, str]]:
    """What the robot did: from, to, one of drive, turn, stand."""
    since, now = drive.start_s, ""
    for state in drive.states():
        doing = (
            "drive"
            if abs(state["v_mm_s"]) > _STANDS_MM_S
            else "turn"
            if abs(state["w_deg_s"]) > 1
            else "stand"
        )
        if doing != now:
            if now:
                yield since, state["t_s"], now
            since, now = state["t_s"], doing
    if now:
        yield since, drive.end_s, now


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


def _draw_time(axes: Axes, drive: Drive) -> None:
    looks = {
        "unknown": ("#eeeeee", ""),
        "healthy": ("#8fd3bd", ""),
        "suspect": (_ORANGE, ""),
        "disabled": (_RED, "///"),
    }
    doing = {"drive": (_BLUE, ""), "turn": (_SKY, ""), "stand": ("#e6e6e6", "")}
    for number in _FRONT:
        _bar(axes, number, health_spans(drive, number), drive.start_s, looks)
    _bar(axes, 7.25, list(_robot_spans(drive)), drive.start_s, doing)
    for one in drive.verdict.findings:
        if one.injected:
            axes.plot(
                one.injected.t_s - drive.start_s,
                one.fault.sonar - 0.52,
                "v",
                ms=8,
                mfc=_RED,
                mec=_INK,
                clip_on=False,
                zorder=5,
            )
        if one.diagnosed:
            axes.plot(
                one.diagnosed.t_s - drive.start_s, one.fault.sonar, "D", ms=6.5, mfc=_SKY, mec=_INK, zorder=5
            )
    axes.set_yticks([*_FRONT, 7.25], [*(f"sonar {number}" for number in _FRONT), "robot"], fontsize=10.5)
    axes.set_ylim(7.75, 0.2)
    axes.set_xlim(0, max(drive.end_s - drive.start_s, 1.0))
    axes.set_xlabel("seconds since the session opened", fontsize=10.5)
    axes.set_title("What Argus held of each sonar, when", fontsize=12, loc="left", color=_INK)
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


# ---- the whole ---------------------------------------------------------------------------------------------


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
        return "Passed: goal reached, nothing hit, every fault found and no other", _GREEN
    failed = ", ".join(rule.name for rule in drive.verdict.rules if not rule.holds)
    return f"Failed: {failed}", _RED


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
        figure = Figure(figsize=_SIZE_IN, dpi=_DPI, facecolor="white")
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
        _draw_map(figure.add_axes((0.02, 0.15, 0.60, 0.715)), drive)
        _legend(figure.add_axes((0.025, 0.015, 0.60, 0.12)), drive)
        _draw_ring(figure.add_subplot(grid[0, 1]), drive)
        _draw_time(figure.add_subplot(grid[1, 1]), drive)
        headline, colour = _headline(drive)
        _write_line(figure, 0.955, drive.title, fontsize=18, fontweight="bold", color=_INK)
        _write_line(figure, 0.92, headline, fontsize=13, fontweight="bold", color=colour)
        _write_line(figure, 0.885, _figures(drive), fontsize=11.5, color=_INK)
        figure.savefig(path, dpi=_DPI, metadata={"Software": None})
