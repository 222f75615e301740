#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Write the manual pages docs/man/*.1: what a program is, by hand below; its options, from its own --help."""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from hil_sim.version import version

ROOT = Path(__file__).resolve().parent.parent
FOLDER = Path("docs/man")
ARGUSD = "build/release/argusd"
WIDE = "10000"  # columns: argparse then breaks no line

EPILOG = """examples:
  tools/gen_man.py            renew the pages
  tools/gen_man.py --check    exit 1 if one of them is not what the programs say

Needs build/release/argusd and the .venv of tools/dev build.
exit codes: 0 done or current, 1 out of date, 2 a program does not answer"""


class ManError(Exception):
    """A page that cannot be made; the message is one line."""


@dataclass(frozen=True)
class Page:
    """One page, but for what --help says."""

    name: str
    what: str
    command: tuple[str, ...]
    synopsis: tuple[str, ...]
    description: tuple[str, ...]
    has_commands: bool = False  # each with a --help of its own
    ends: tuple[tuple[str, tuple[tuple[str, str], ...]], ...] = ()
    also: tuple[str, ...] = field(default=())


PAGES = (
    Page(
        name="argusd",
        what="drives an ARCOS robot and keeps it safe when its sonars fail",
        command=(ARGUSD,),
        synopsis=("--link LINK [options]",),
        description=(
            "argusd talks to the microcontroller of a Pioneer P3-DX, judges every sonar, works round those that "
            "failed, and drives a course under its safety rules. Only a TCP link to this machine drives at once; "
            "every other link only watches until you give --active. Watching, argusd reports and commands no motion.",
            "On a terminal it shows a screen; with --plain or --json, or where there is none, it writes a line "
            "for each event on standard output. Errors and what an operator should know go to standard error.",
            "SIGINT, SIGTERM and SIGHUP stop the robot and close the session; signals within a second count as "
            "one, a later one ends argusd at once.",
        ),
        ends=(
            (
                "ENVIRONMENT",
                (
                    ("NO_COLOR", "if set and not empty, nothing is coloured"),
                    ("NOTIFY_SOCKET", "where systemd is told READY, STATUS and STOPPING (sd_notify(3))"),
                    ("WATCHDOG_USEC", "... and WATCHDOG, twice in this time"),
                    ("TERM", "the terminal; where it cannot be drawn on, argusd does as with --plain"),
                ),
            ),
            (
                "FILES",
                (
                    ("argusd.conf.example", "a config file with every setting, among the documentation"),
                    (
                        "argusd.service",
                        "the unit for systemd: told when argusd is up, alive, and how it does",
                    ),
                    ("60-argus.rules", "the rules for udev: a fixed name for the robot's serial adapter"),
                    ("argus.dbc", "the CAN frames, for any tool that reads DBC files"),
                ),
            ),
        ),
        also=("argusctl", "argus-log", "argus-sim"),
    ),
    Page(
        name="argus-sim",
        what="emulates an ARCOS robot with its world, sonars and faults",
        command=(sys.executable, "-m", "hil_sim.cli"),
        synopsis=("[options]", "bench NAME [options]", "experiment NAME [options]"),
        description=(
            "argus-sim is a robot for programs that speak ARCOS: drive, odometry, sonars and bumpers in a world "
            "of walls, with faults of its sonars on demand.",
        ),
        also=("argusd", "argus-log", "argus-monitor"),
    ),
    Page(
        name="argus-monitor",
        what="shows a robot, its sonars and their faults in the browser, and drives it from there",
        command=(sys.executable, "-m", "argus_tools.monitor.cli"),
        synopsis=("--connect ADDRESS [options]", "--sim [options]"),
        description=(
            "argus-monitor is a client of argusd's control socket and a web server on loopback: a page with the "
            "robot from above, the beam and the health of every sonar, the rotations that cover for those that "
            "failed, and the orders that an operator may give. Several may look on; argusd lets one order.",
            "With --sim it starts an emulated robot and argusd first; a click on a sonar then breaks or mends it.",
        ),
        ends=(
            (
                "ENVIRONMENT",
                (("ARGUS_ARGUSD", "with --sim: the argusd to run, unless --argusd names one"),),
            ),
        ),
        also=("argusd", "argus-sim"),
    ),
    Page(
        name="argusctl",
        what="asks, watches and orders a running argusd",
        command=(sys.executable, "-m", "argus_tools.control.cli"),
        synopsis=("[--socket PLACE] [--token FILE] COMMAND [options]",),
        description=(
            "argusctl speaks to an argusd that was started with --control: it tells its state, follows its events, "
            "drives the robot and, where argusd was started with --inject, makes a sonar fail for a test.",
            "An order takes control and gives it back. step and turn wait until the robot stands; when they are "
            "interrupted, the robot is stopped. When another stops it before it is done, they say so and end with 1.",
        ),
        has_commands=True,
        ends=(
            (
                "ENVIRONMENT",
                (
                    (
                        "ARGUS_CONTROL",
                        "where argusd is, when --socket does not say: unix:PATH or tcp:HOST:PORT",
                    ),
                ),
            ),
            (
                "FILES",
                (("/run/argus/control", "where argusd is, when neither says"),),
            ),
        ),
        also=("argusd", "argus-log"),
    ),
    Page(
        name="argus-log",
        what="decodes, checks, converts, draws and replays logs of a robot's link",
        command=(sys.executable, "-m", "argus_tools.log.cli"),
        synopsis=("COMMAND [options] LOG",),
        description=(
            "argus-log reads what passed on a robot's serial, TCP or CAN link, whoever recorded it.",
        ),
        has_commands=True,
        ends=(
            (
                "ENVIRONMENT",
                (
                    (
                        "ARGUS_CORE",
                        "the libargus.so that faults takes, instead of the one it finds or compiles",
                    ),
                ),
            ),
        ),
        also=("argusd", "argus-sim"),
    ),
    Page(
        name="argus-foxglove",
        what="shows live in Foxglove what argusd knows of a robot",
        command=(sys.executable, "-m", "argus_tools.foxglove_bridge"),
        synopsis=("[options]",),
        description=(
            "argus-foxglove is a client of argusd's control socket and a WebSocket server on loopback, for "
            "Foxglove. It only shows; argusd may come and go meanwhile.",
        ),
        ends=(("ENVIRONMENT", (("ARGUS_CONTROL", "the control socket, unless --control names one"),)),),
        also=("argusd", "argus-log", "argus-monitor"),
    ),
    Page(
        name="argus-ros",
        what="is the ROS 2 node of a robot that argusd minds",
        command=(sys.executable, "-m", "argus_ros.cli", "argus-ros"),
        synopsis=("[--ros-args ARGUMENTS]",),
        description=(
            "argus-ros tells on the topics of a driver what argusd knows: a range for each sonar, a cloud of echoes, "
            "diagnoses, odometry, battery and frames. With the parameter guard it takes cmd_vel, which argusd's guard "
            "bounds. It needs rclpy, of a ROS 2 installation or from PyPI.",
        ),
        ends=(("ENVIRONMENT", (("ARGUS_CONTROL", "the control socket, unless control names one"),)),),
        also=("argusd", "argus-range-guard", "argus-foxglove"),
    ),
    Page(
        name="argus-range-guard",
        what="is a ROS 2 node that repairs the sonar ranges of any driver",
        command=(sys.executable, "-m", "argus_ros.cli", "argus-range-guard"),
        synopsis=("[--ros-args ARGUMENTS]",),
        description=(
            "argus-range-guard runs the fault manager on the sensor_msgs/Range topics and the odometry of any driver, "
            "and publishes each repaired as TOPIC/guarded. It needs no argusd, and commands no motion. It needs rclpy, "
            "of a ROS 2 installation or from PyPI.",
        ),
        also=("argus-ros", "argusd"),
    ),
    Page(
        name="argus-flash-check",
        what="checks whether the image that was flashed into a board runs as it should",
        command=(sys.executable, "-m", "argus_tools.flash_check"),
        synopsis=("DEVICE [options]",),
        description=(
            "argus-flash-check listens at the operator's UART of a board, orders it to restart, and looks at what "
            "it then says: what it is and runs with, why it started, whether its link comes up, and how much of "
            "its stack was never used. It commands no motion.",
        ),
        also=("argusd", "argus-sim"),
    ),
    Page(
        name="argus-conformance",
        what="checks an ARCOS server from outside",
        command=(sys.executable, "-m", "hil_sim.conformance.cli"),
        synopsis=("--target TARGET [options]",),
        description=(
            "argus-conformance connects to a robot, or to an emulator of one, as a client does, and checks what it "
            "says and does against the protocol.",
        ),
        also=("argusd", "argus-sim"),
    ),
)


def lines_of(text: str) -> list[str]:
    """Return the lines of a help text as Python 3.13 writes them: a value behind the last form of an option only."""
    return re.sub(r"^( +-\w) (\S+), (--[\w-]+ \2)", r"\1, \3", text, flags=re.MULTILINE).splitlines()


def help_of(command: tuple[str, ...]) -> list[str]:
    """Return the lines that a program prints for --help."""
    path = os.pathsep.join(str(ROOT / folder) for folder in (".", "tools"))
    environment = {**os.environ, "COLUMNS": WIDE, "PYTHONPATH": path}
    try:
        done = subprocess.run(
            [*command, "--help"], cwd=ROOT, env=environment, check=True, capture_output=True, text=True
        )
    except (OSError, subprocess.CalledProcessError) as error:
        raise ManError(f"{' '.join(command)} --help fails ({error}); run tools/dev build release") from error
    return lines_of(done.stdout)


def escaped(text: str) -> str:
    """Return text as roff shows it unchanged; a hyphen of an option must stay one."""
    shown = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + shown if shown.startswith((".", "'")) else shown


def sections(lines: list[str]) -> Iterator[tuple[str, list[str]]]:
    """Split help into (title, lines), from its usage on; of the usage itself nothing is kept but options below it."""
    title, body = "", list[str]()
    for line in lines:
        heading = re.fullmatch(r"([a-z][^:(]*(?:\([^)]*\))?):(?: (.*))?", line)
        if line.startswith("usage:"):
            title, body = "options", []
        elif heading and title:
            yield title, [kept for kept in body if title != "options" or kept.startswith("  ")]
            title, body = heading[1], [heading[2]] if heading[2] else []
        else:
            body.append(line)
    yield title, body


def entries(body: list[str]) -> list[tuple[str, str]] | None:
    """Return (option, text) of a section that lists them, or None if it is no such section."""
    found: list[list[str]] = []
    for line in filter(None, body):
        if re.match(r"  \S", line) and not re.match(r" {2}(argus|dask)\S* ", line):
            head, _, text = line.strip().partition("  ")
            found.append([head, text.strip()])
        elif found and line.startswith("     "):
            found[-1][1] = f"{found[-1][1]} {line.strip()}".strip()
        else:
            return None
    return [(head, text) for head, text in found] or None


def rendered(title: str, body: list[str]) -> list[str]:
    """Return one section of help as roff."""
    body = "\n".join(body).strip("\n").split("\n")
    options = None if title == "examples" else entries(body)
    if options is None:
        return [".nf", *(escaped(line) for line in body), ".fi"]
    lines = []
    for head, text in options:
        lines += [".TP", f".B {escaped(head)}", escaped(text) or "\\&"]
    return lines


def from_help(lines: list[str], heading: str) -> list[str]:
    """Return all sections of help, each under a heading of its own."""
    out = []
    for title, body in sections(lines):
        if any(body):
            name = title.upper() if heading == ".SH" else title
            out += [f'{heading} "{escaped(name)}"', *rendered(title, body)]
    return out


def page(description: Page, version: str) -> str:
    """Return a whole page."""
    name = description.name
    lines = [
        '.\\" SPDX-License-Identifier: MIT',
        ".\\\" Written by tools/gen_man.py; change what it says there, or in the program's --help.",
        f'.TH {name.upper()} 1 "" "Argus {version}" "Argus"',
        ".nh",
        ".ad l",
        ".SH NAME",
        f"{name} \\- {escaped(description.what)}",
        ".SH SYNOPSIS",
    ]
    for synopsis in description.synopsis:
        lines += [f".B {escaped(name)}", escaped(synopsis), ".br"]
    lines[-1:] = [".SH DESCRIPTION"]
    for paragraph in description.description:
        lines += [".PP", escaped(paragraph)]
    told = help_of(description.command)
    lines += from_help(told, ".SH")
    for command in (
        re.findall(r"^    (\w+) {2,}", "\n".join(told), re.MULTILINE) if description.has_commands else ()
    ):
        lines.append(f'.SH "{escaped(name.upper())} {command.upper()}"')
        lines += from_help(help_of((*description.command, command)), ".SS")
    for title, items in description.ends:
        lines.append(f'.SH "{title}"')
        for head, text in items:
            lines += [".TP", f".B {escaped(head)}", escaped(text)]
    lines.append(".SH SEE ALSO")
    lines.append(", ".join(f"\\fB{escaped(other)}\\fR(1)" for other in description.also))
    return "\n".join(lines) + "\n"


def main(argv: list[str] | None = None) -> int:
    """Run the command line and return its exit code."""
    parser = argparse.ArgumentParser(
        prog="tools/gen_man.py",
        description=__doc__,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "--check", action="store_true", help="change nothing; exit 1 when a page is out of date"
    )
    args = parser.parse_args(argv)
    code = 0
    try:
        for description in PAGES:
            path = ROOT / FOLDER / f"{description.name}.1"
            text = page(description, version())
            if path.exists() and path.read_text(encoding="utf-8") == text:
                continue
            if args.check:
                print(
                    f"gen_man: {path.relative_to(ROOT)} is out of date; run tools/gen_man.py", file=sys.stderr
                )
                code = 1
            else:
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
    except ManError as error:
        print(f"gen_man: {error}", file=sys.stderr)
        return 2
    return code


if __name__ == "__main__":
    sys.exit(main())
