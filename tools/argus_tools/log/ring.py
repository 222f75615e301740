# SPDX-License-Identifier: MIT
"""`argus-log ring`: checks the file of a ring, draws it for a person to sign off, and writes the whole of it."""

from __future__ import annotations

import argparse
import math
import sys
from pathlib import Path
from typing import Any, Final

from argus_tools.formats import LogError
from argus_tools.log.common import binary_output
from argus_tools.log.exits import EXIT_READ
from hil_sim.tables.ring import ring_file
from hil_sim.tables.robot import RobotTable, robot_table
from hil_sim.tables.write import toml_of

EXAMPLES: Final = """\
  argus-log ring my.toml                      what is in it, or file, line and what is wrong
  argus-log ring my.toml -o my.png            the picture: are the sonars where they are?
  argus-log ring my.toml --whole all.toml     with all that it inherits, as argusd reads it
  argus-log ring --draft robot.urdf > my.toml       a draft of it; of a bag, too
"""
_TINT: Final = {"ahead": "#0072b2", "astern": "#009e73", "abeam": "#e69f00", "none": "#999999"}
_CONE_MM: Final = 450.0
_NUMBER_MM: Final = 40.0


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    parser.add_argument("ring", metavar="FILE", help="the ring, of the form of hil_sim/tables/robots")
    parser.add_argument(
        "--draft",
        action="store_true",
        help="FILE is a URDF, or a bag with Range messages and transforms: write a draft to standard output",
    )
    parser.add_argument("-o", "--output", metavar="FILE", help="draw it: .png or .svg")
    parser.add_argument(
        "--whole", metavar="FILE", help="write it with all that it inherits; - is standard output"
    )


def run(args: argparse.Namespace) -> int:
    """Check, then report, draw, write; return the exit code."""
    if args.draft:
        from argus_tools.log.draft import drafted

        sys.stdout.write(drafted(Path(args.ring)))
        return EXIT_READ
    form = Path(args.output or "x.png").suffix.lower().removeprefix(".")
    if form not in ("png", "svg"):
        raise LogError(f"{args.output}: a picture ends in .png or .svg")
    robot = robot_table(ring_file(args.ring))
    if args.whole:
        text = toml_of(robot)
        if args.whole == "-":
            sys.stdout.write(text)
            return EXIT_READ
        Path(args.whole).write_text(text, encoding="utf-8")
    print("\n".join(words(robot)))
    if args.output:
        figure = drawn(robot)
        with binary_output(args.output) as stream:
            metadata = {"Date": None} if form == "svg" else {"Software": None}
            figure.savefig(stream, format=form, dpi=110, metadata=metadata)
    return EXIT_READ


def words(robot: RobotTable) -> list[str]:
    """Return what a ring is, in lines."""
    body = robot.body
    lines = [
        f"{robot.subclass}: {robot.sonars} sonars in {len(robot.orders)} arrays; nothing is wrong",
        f"body {body.front_mm:g} mm ahead, {body.rear_mm:g} behind, {2 * body.half_mm:g} wide; swings within "
        f"{body.swing_mm:g} mm",
        f"readings from {robot.min_mm} mm; {robot.no_echo_mm} mm or more is no echo; cone {robot.cone_deg} degrees",
        "sonar     x     y  heading  role    array",
    ]
    for number, mount in enumerate(robot.mounts):
        forward = "  faces forward" if number in robot.forward else ""
        at = f"{number:5d} {mount.x_mm:5g} {mount.y_mm:5g} {mount.heading_deg:8g}"
        lines.append(f"{at}  {mount.role:<7} {mount.array:5d}{forward}")
    return lines


def drawn(robot: RobotTable) -> Any:
    """Return the picture: body, swing circle, and the cone of each sonar with its number, ahead upwards."""
    from matplotlib.figure import Figure
    from matplotlib.patches import Circle, Polygon, Wedge

    figure = Figure(figsize=(7, 7), layout="constrained")
    axes = figure.add_subplot()
    axes.set_aspect("equal")
    axes.add_patch(Polygon([(-y, x) for x, y in robot.body.corners], fill=False, color="black"))
    axes.add_patch(Circle((0, 0), robot.body.swing_mm, fill=False, linestyle=":", color="black"))
    half = robot.cone_deg / 2
    for number, mount in enumerate(robot.mounts):
        at, up = (-mount.y_mm, mount.x_mm), mount.heading_deg + 90
        tint = _TINT[mount.role]
        axes.add_patch(Wedge(at, _CONE_MM, up - half, up + half, color=tint, alpha=0.18))
        turn = math.radians(up)
        tip = at[0] + _CONE_MM * math.cos(turn), at[1] + _CONE_MM * math.sin(turn)
        axes.annotate("", tip, at, arrowprops={"arrowstyle": "->", "color": tint})
        beyond = tip[0] + _NUMBER_MM * math.cos(turn), tip[1] + _NUMBER_MM * math.sin(turn)
        is_forward = number in robot.forward
        axes.text(*beyond, str(number), ha="center", va="center", weight="bold" if is_forward else "normal")
    for role, tint in _TINT.items():
        if any(mount.role == role for mount in robot.mounts):
            axes.plot([], [], color=tint, label=role)
    reach = robot.body.reach_mm + _CONE_MM + 2 * _NUMBER_MM
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach), xlabel="right, mm", ylabel="ahead, mm")
    axes.set_title(f"{robot.subclass}: ahead is up; bold numbers face forward")
    axes.legend(loc="lower right")
    return figure
