# SPDX-License-Identifier: MIT
"""`argus-log plot`: pictures of a log: readings over time, the path driven, the sonar ring at one moment."""

from __future__ import annotations

import argparse
import datetime
import math
import sys
from array import array
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from argus_tools.formats import LogError
from argus_tools.log.common import (
    Input,
    Times,
    add_log_arguments,
    add_robot_arguments,
    add_time_arguments,
    binary_output,
    seconds,
    sonar_numbers,
)
from argus_tools.log.convert import clocked
from argus_tools.log.fields import Decoder
from argus_tools.log.spans import DEAD, SUSPECT, find_spans
from hil_sim.tables import load

EXAMPLES: Final = """\
  argus-log plot drive.rec -o drive.png                        each sonar over time; dead and suspect spans shaded
  argus-log plot drive.rec -o front.svg --sonar 0-7 --from +20 --to +40
  argus-log plot drive.rec -o path.png --view path
  argus-log plot drive.rec -o ring.png --view ring --at +31.5
"""
_SONAR: Final[dict[str, Any]] = load("robots/p3dx-sh")["sonar"]
_BODY: Final[dict[str, int]] = load("robots/p3dx-sh")["body"]
POSES: Final = {pose["number"]: pose for pose in _SONAR["pose"]}
NO_ECHO_MM: Final[int] = _SONAR["no_echo_mm"]
# More points than this are not told apart in a picture.
POINTS_MAX: Final = 1 << 13
_INK, _LINE, _GRID, _SILENT = "#222222", "#1f5fa8", "#dddddd", "#777777"
_COLOUR: Final = {DEAD: "#d62728", SUSPECT: "#f2a900"}
_LABEL: Final = {DEAD: "dead: off, silent or disabled", SUSPECT: "suspect"}
_STYLE: Final[Any] = {
    "svg.hashsalt": "argus",
    "font.size": 9,
    "axes.edgecolor": "#888888",
    "axes.linewidth": 0.6,
}
# A reading this much older than the moment shown is drawn pale.
FRESH_S: Final = 0.5
_OLD: Final = f"older than {FRESH_S} s"
# What a ring may show, in the order of its legend: colour and strength.
_RING: Final = {
    "echo": (_LINE, 0.6),
    "no echo": (_SILENT, 0.3),
    _OLD: (_LINE, 0.2),
    **{_LABEL[kind]: (_COLOUR[kind], 0.4) for kind in (DEAD, SUSPECT)},
}
# Times from here on count from 1970: those of a clock that counts from its own start are smaller.
CALENDAR_S: Final = 1e9
# The picture of the ring: how far it reaches, and half of a letter's width and height in its text, all in mm.
RING_MM: Final = NO_ECHO_MM + 1500
HALF_LETTER_MM: Final = (70.0, 130.0)
Box = tuple[float, float, float, float]


@dataclass
class Series:
    """Values over time that never take more than a fixed amount of memory; extremes survive."""

    t: array[float] = field(default_factory=lambda: array("d"))
    value: array[float] = field(default_factory=lambda: array("d"))

    def add(self, t: float, value: float) -> None:
        """Append one value."""
        self.t.append(t)
        self.value.append(value)
        if len(self.t) >= 2 * POINTS_MAX:
            self._thin()

    def _thin(self) -> None:
        """Keep the smallest and the largest of each four values."""
        values = np.array(self.value).reshape(-1, 4)
        at = np.sort(np.stack([values.argmin(axis=1), values.argmax(axis=1)], axis=1), axis=1)
        index = (at + 4 * np.arange(len(values))[:, None]).ravel()
        self.t = array("d", np.array(self.t)[index].tobytes())
        self.value = array("d", np.array(self.value)[index].tobytes())


@dataclass
class Drive:
    """What a log says of a drive, as far as pictures need it."""

    sonars: dict[int, Series] = field(default_factory=dict)
    path: array[float] = field(default_factory=lambda: array("d"))
    start: float = math.inf
    end: float = -math.inf
    has_sonars: bool = True
    _skip: int = 1
    _seen: int = 0

    def add(self, t: float, data: bytes, pose: tuple[float, float, float]) -> None:
        """Take one SIP and where the robot was; the last reading of a sonar counts."""
        self.start, self.end = min(self.start, t), max(self.end, t)
        places = range(20, 20 + 3 * data[19], 3) if self.has_sonars else ()
        last = {data[at]: data[at + 1] | data[at + 2] << 8 for at in places}
        for number, range_mm in last.items():
            series = self.sonars.get(number)
            if series is None:
                series = self.sonars[number] = Series()
            series.add(t, range_mm)
        if self._seen % self._skip == 0:
            self.path.extend((t, *pose))
            if len(self.path) >= 8 * POINTS_MAX:
                self.path = array("d", np.array(self.path).reshape(-1, 4)[::2].tobytes())
                self._skip *= 2
        self._seen += 1


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_log_arguments(parser)
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help="the picture: .png or .svg")
    parser.add_argument("--view", choices=("ranges", "path", "ring"), default="ranges", help="what is drawn")
    parser.add_argument(
        "--at", type=seconds, metavar="T", help="moment of the ring (default: the end); as --from"
    )
    parser.add_argument("--sonar", type=sonar_numbers, metavar="N,...", help="these sonars only")
    add_robot_arguments(parser)
    parser.add_argument(
        "--profile", default="argus", metavar="NAME", help="rules that find what is shaded (default: argus)"
    )
    parser.add_argument(
        "--no-faults", action="store_true", help="shade nothing: do not run the fault manager"
    )
    add_time_arguments(parser)


def run(args: argparse.Namespace) -> int:
    """Draw the picture; return the exit code."""
    form = Path(args.output).suffix.lower().removeprefix(".")
    if form not in ("png", "svg"):
        raise LogError(f"{args.output}: a picture ends in .png or .svg")
    source = Input(args)
    if args.view == "ring":
        figure = _ring(args, source)
    else:
        drive = _read(args, source)
        figure = _path(drive) if args.view == "path" else _ranges(args, drive)
    with rc_context(_STYLE), binary_output(args.output) as stream:
        metadata = {"Date": None} if form == "svg" else {"Software": None}
        figure.savefig(stream, format=form, dpi=110, metadata=metadata)
    return source.exit_code


def _read(args: argparse.Namespace, source: Input) -> Drive:
    times = Times(args.start, args.end)
    decoder = Decoder(args.subclass)
    drive = Drive(has_sonars=args.view == "ranges")
    for row in clocked(source):
        decoder.track(row)
        if times(row.t, args.log) and row.type == "SIP" and row.ok and row.t is not None:
            data = row.data
            if len(data) >= 20 and len(data) >= 20 + 3 * data[19]:
                drive.add(row.t, data, (decoder.x_mm, decoder.y_mm, decoder.heading_deg(data)))
    if not drive.path:
        raise LogError(f"{args.log}: has no SIP to draw (in the time asked for)")
    return drive


def _calendar(t: float) -> str:
    """Return a time as people read it; empty if it is of a clock that does not know the day.

    >>> _calendar(1795590184.578)
    '2026-11-25 07:03:04 UTC'
    """
    if t < CALENDAR_S:
        return ""
    return f"{datetime.datetime.fromtimestamp(t, datetime.UTC):%Y-%m-%d %H:%M:%S} UTC"


def _figure(width: float, height: float) -> Figure:
    return Figure(figsize=(width, height), facecolor="white", layout="constrained")


# ---- readings over time


def _ranges(args: argparse.Namespace, drive: Drive) -> Figure:
    numbers = [n for n in sorted(drive.sonars) if not args.sonar or n in args.sonar]
    if not numbers:
        raise LogError(f"{args.log}: has no reading of the sonars asked for")
    spans, note = ([], "not asked for") if args.no_faults else find_spans(args)
    if note and not args.no_faults:
        print(f"argus-log: no span is shaded: {note}", file=sys.stderr)
    columns = 1 if len(numbers) <= 4 else 2
    rows = math.ceil(len(numbers) / columns)
    # The time axis begins at 0, as clocks that count from 1970 have too many digits for one.
    zero = drive.start
    with rc_context(_STYLE):
        figure = _figure(12 if columns == 2 else 9, 1.2 + 1.3 * rows)
        grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
        for at, number in enumerate(numbers):
            axes = grid[at % rows][at // rows]
            _one_sonar(axes, number, drive.sonars[number], zero)
            for span in spans:
                if span.sonar == number and span.end >= drive.start and span.start <= drive.end:
                    left, right = max(span.start, drive.start), min(span.end, drive.end)
                    axes.axvspan(left - zero, right - zero, color=_COLOUR[span.kind], alpha=0.28, linewidth=0)
        for axes in list(grid.T.flat)[len(numbers) :]:
            axes.set_visible(False)
        for column in range(columns):
            shown = [grid[row][column] for row in range(rows) if grid[row][column].get_visible()]
            shown[-1].set_xlabel("s since the first SIP shown")
            shown[-1].tick_params(labelbottom=True)
        handles: list[Any] = [
            Line2D([], [], color=_LINE, linewidth=1, label="reading, mm"),
            Line2D(
                [],
                [],
                color=_INK,
                linestyle="none",
                marker="|",
                markersize=5,
                label=f"no echo ({NO_ECHO_MM})",
            ),
        ]
        occurring = {span.kind for span in spans if span.sonar in numbers}
        handles += [
            Patch(color=_COLOUR[kind], alpha=0.4, label=_LABEL[kind])
            for kind in (DEAD, SUSPECT)
            if kind in occurring
        ]
        title = f"{Path(args.log).name}: sonar readings over time" + (" (not judged)" if note else "")
        if _calendar(zero):
            title += f", from {_calendar(zero)} on"
        figure.suptitle(title, fontsize=11, color=_INK)
        _legend(figure, handles, 4)
    return figure


def _legend(figure: Figure, handles: list[Any], columns: int) -> None:
    """Add a legend below all panels; an older matplotlib, as Debian 12 has it, must be told to leave it room."""
    try:
        figure.legend(handles=handles, loc="outside lower center", ncols=columns, frameon=False)
    except ValueError:
        figure.get_layout_engine().set(rect=(0, 0.06, 1, 0.94))  # type: ignore[union-attr, call-arg]
        figure.legend(handles=handles, loc="lower center", ncols=columns, frameon=False)


def _one_sonar(axes: Any, number: int, series: Series, zero: float) -> None:
    t = np.array(series.t) - zero
    value = np.array(series.value)
    echo = np.where(value < NO_ECHO_MM, value, np.nan)
    axes.plot(t, echo, color=_LINE, linewidth=0.9, marker=".", markersize=1.8, markeredgewidth=0)
    none = t[value >= NO_ECHO_MM]
    axes.plot(none, np.full(len(none), NO_ECHO_MM), color=_INK, linestyle="none", marker="|", markersize=4,
              markeredgewidth=0.6)  # fmt: skip
    pose = POSES.get(number)
    name = f"sonar {number}" + (f" at {pose['heading_deg']:+d}°" if pose else "")
    axes.set_title(name, loc="left", fontsize=9, pad=3, color=_INK)
    axes.set_ylim(0, NO_ECHO_MM * 1.06)
    axes.set_yticks([0, 2500, NO_ECHO_MM])
    axes.grid(color=_GRID, linewidth=0.5)
    axes.set_axisbelow(True)


# ---- the path


def _path(drive: Drive) -> Figure:
    t, x, y, heading = np.array(drive.path).reshape(-1, 4).T
    with rc_context(_STYLE):
        figure = _figure(8, 7)
        axes = figure.subplots()
        axes.plot(x, y, color=_LINE, linewidth=1.4, zorder=2)
        moved = np.hypot(np.diff(x, prepend=x[0]), np.diff(y, prepend=y[0])).cumsum()
        if moved[-1] > 0:
            at = np.searchsorted(moved, np.linspace(0, moved[-1], 12)[1:-1])
            turn = np.radians(heading[at])
            axes.quiver(x[at], y[at], np.cos(turn), np.sin(turn), color=_LINE, angles="xy", scale=28, width=0.005,
                        pivot="mid", zorder=3)  # fmt: skip
            for index in at[::3]:
                label = f"{t[index] - t[0]:.0f} s"
                axes.annotate(
                    label, (x[index], y[index]), (6, 6), textcoords="offset points", color=_INK, fontsize=8
                )
        axes.plot(
            x[0], y[0], marker="o", color="#2ca02c", markersize=9, linestyle="none", label="start", zorder=4
        )
        axes.plot(
            x[-1],
            y[-1],
            marker="s",
            color=_COLOUR[DEAD],
            markersize=8,
            linestyle="none",
            label="end",
            zorder=4,
        )
        axes.set_aspect("equal", adjustable="box")
        middle_x, middle_y = (x.min() + x.max()) / 2, (y.min() + y.max()) / 2
        half = max(np.ptp(x), np.ptp(y), 800.0) * 0.58
        axes.set_xlim(middle_x - half, middle_x + half)
        axes.set_ylim(middle_y - half, middle_y + half)
        axes.set_xlabel("x, mm (odometry)")
        axes.set_ylabel("y, mm")
        axes.grid(color=_GRID, linewidth=0.5)
        axes.set_axisbelow(True)
        axes.legend(frameon=False)
        axes.set_title(f"path: {moved[-1] / 1000:.2f} m in {t[-1] - t[0]:.1f} s", fontsize=11, color=_INK)
    return figure


# ---- the ring


def _ring(args: argparse.Namespace, source: Input) -> Figure:
    last: dict[int, tuple[float, int]] = {}
    first = moment = shown_t = None
    for row in clocked(source):
        if row.type != "SIP" or not row.ok or row.t is None:
            continue
        first = row.t if first is None else first
        if args.at is not None:
            moment = args.at[1] + (first if args.at[0] else 0.0)
            if row.t > moment:
                break
        data = row.data
        shown_t = row.t
        for at in range(20, min(20 + 3 * data[19], len(data) - 2) if len(data) > 19 else 0, 3):
            last[data[at]] = (row.t, data[at + 1] | data[at + 2] << 8)
    if shown_t is None or first is None:
        raise LogError(f"{args.log}: has no SIP at or before the moment asked for")
    moment = shown_t if moment is None else min(moment, shown_t)
    spans, note = ([], "not asked for") if args.no_faults else find_spans(args)
    if note and not args.no_faults:
        print(f"argus-log: no sonar is judged: {note}", file=sys.stderr)
    held = {span.sonar: span.kind for span in spans if span.start <= moment <= span.end}
    return _draw_ring(Path(args.log).name, moment, moment - first, last, held)


def ring_title(name: str, moment: float, since: float) -> str:
    """Return the title of the ring: which log, how long after its beginning, and the time of day if known.

    >>> ring_title("drive.rec", 12.5, 12.5)
    'drive.rec: the sonar ring, up is ahead\\n12.5 s after the first SIP'
    """
    day = f", {_calendar(moment)}" if _calendar(moment) else ""
    return f"{name}: the sonar ring, up is ahead\n{since:.1f} s after the first SIP{day}"


def reading_text(number: int, range_mm: int, held: str | None) -> str:
    """Return what is written beside a sonar: its number, what it reads in the unit of the rings, and its verdict.

    >>> reading_text(1, 1253, None), reading_text(3, 5000, "suspect")
    ('1: 1.25 m', '3: no echo, suspect')
    """
    reads = f"{range_mm / 1000:.2f} m" if range_mm < NO_ECHO_MM else "no echo"
    return f"{number}: {reads}" + (f", {held}" if held else "")


def ring_legend(moment: float, last: Mapping[int, tuple[float, int]], held: Mapping[int, str]) -> list[str]:
    """Return what the ring shows, each once: nothing is in its legend that is not drawn.

    >>> ring_legend(9.0, {1: (9.0, 800), 3: (9.0, 5000)}, {3: "suspect"})
    ['echo', 'suspect']
    >>> ring_legend(9.0, {1: (9.0, 5000), 2: (7.0, 900)}, {})
    ['echo', 'no echo', 'older than 0.5 s']
    """
    drawn = set()
    for number in POSES.keys() & last.keys():
        t, range_mm = last[number]
        plain = "echo" if range_mm < NO_ECHO_MM else "no echo"
        drawn.add(_LABEL[held[number]] if number in held else plain)
        if moment - t > FRESH_S:
            drawn.add(_OLD)
    return [name for name in _RING if name in drawn]


def _draw_ring(
    name: str, moment: float, since: float, last: dict[int, tuple[float, int]], held: dict[int, str]
) -> Figure:
    half = math.radians(_SONAR["cone_deg"]) / 2
    with rc_context(_STYLE):
        figure = _figure(8, 8.2)
        axes: Any = figure.add_subplot(projection="polar")
        axes.set_theta_zero_location("N")
        shown: list[tuple[float, float, str]] = []
        points: list[tuple[float, float]] = []
        for number, (t, range_mm) in sorted(last.items()):
            if number not in POSES:
                continue
            pose = POSES[number]
            turn, width = _wedge(number, half * 0.62)
            stand = math.hypot(pose["x_mm"], pose["y_mm"])
            is_echo = range_mm < NO_ECHO_MM
            alpha = 0.55 if moment - t <= FRESH_S else 0.2
            verdict = held.get(number)
            colour = _COLOUR[verdict] if verdict else _LINE if is_echo else _SILENT
            axes.bar(turn, range_mm, width=2 * width, bottom=stand, color=colour,
                     alpha=alpha if is_echo else alpha * 0.35, linewidth=0)  # fmt: skip
            edge = stand + range_mm
            arc = np.linspace(turn - width, turn + width, 25)
            axes.plot(arc, np.full(25, edge), color=colour, linewidth=2.2, alpha=min(1.0, alpha + 0.4))
            points += [_across(angle, edge) for angle in arc]
            shown.append((turn, edge, reading_text(number, range_mm, verdict)))
        taken: list[Box] = []
        for turn, edge, text in shown:
            at, box = _place(turn, edge, text, taken, points)
            taken.append(box)
            axes.text(turn, at, text, ha="center", va="center", fontsize=8, color=_INK)
        _draw_body(axes)
        axes.set_ylim(0, RING_MM)
        axes.set_yticks(
            range(1000, NO_ECHO_MM + 1, 1000), [f"{metres} m" for metres in range(1, 6)], color="#888888"
        )
        axes.set_rlabel_position(110)  # no sonar looks there
        axes.set_thetagrids(range(0, 360, 30), [f"{a if a <= 180 else a - 360}°" for a in range(0, 360, 30)])
        axes.grid(color=_GRID, linewidth=0.6)
        axes.set_axisbelow(True)
        axes.set_title(ring_title(name, moment, since), fontsize=11, color=_INK, pad=18)
        names = ring_legend(moment, last, held)
        _legend(
            figure,
            [Patch(color=_RING[name][0], alpha=_RING[name][1], label=name) for name in names],
            len(names),
        )
    return figure


def _across(turn: float, distance: float) -> tuple[float, float]:
    """Return a place of the ring in mm to the right and up of its middle."""
    return -distance * math.sin(turn), distance * math.cos(turn)


def _place(
    turn: float, edge: float, text: str, taken: Sequence[Box], points: Sequence[tuple[float, float]]
) -> tuple[float, Box]:
    """Return how far out a label stands so that it is on no arc and no other label, and its box."""
    wide, high = HALF_LETTER_MM[0] * len(text), HALF_LETTER_MM[1]
    at = edge + 100 + wide * abs(math.sin(turn)) + high * abs(math.cos(turn))
    while True:
        x, y = _across(turn, at)
        box = (x - wide, y - high, x + wide, y + high)
        on_label = any(
            box[0] < other[2] and other[0] < box[2] and box[1] < other[3] and other[1] < box[3]
            for other in taken
        )
        on_arc = any(box[0] < px < box[2] and box[1] < py < box[3] for px, py in points)
        if at >= RING_MM or not (on_label or on_arc):
            return at, box
        at += 40


def _wedge(number: int, half: float) -> tuple[float, float]:
    """Return the middle and the half width to draw; two sonars that look the same way share the width."""
    pose = POSES[number]
    turn = math.radians(pose["heading_deg"])
    twin = next(
        (p for n, p in POSES.items() if n != number and p["heading_deg"] == pose["heading_deg"]), None
    )
    if twin is None:
        return turn, half
    is_ahead = pose["x_mm"] > twin["x_mm"]
    return turn - math.copysign(half / 2, turn) * (1 if is_ahead else -1), half / 2


def _draw_body(axes: Any) -> None:
    front, rear, side = _BODY["front_mm"], -_BODY["rear_mm"], _BODY["width_mm"] / 2
    corners = np.array([(front, side), (front, -side), (rear, -side), (rear, side), (front, side)])
    turn = np.arctan2(corners[:, 1], corners[:, 0])
    axes.fill(turn, np.hypot(corners[:, 0], corners[:, 1]), color="#555555", zorder=5)
