# SPDX-License-Identifier: MIT
"""Draw docs/img/diagrams/*.svg, the diagrams of the documents, from the lists below. --check: only compare."""

from __future__ import annotations

import argparse
import itertools
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Final
from xml.sax.saxutils import escape

ROOT: Final = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from hil_sim.scenario.scenario import load_scenario  # noqa: E402
from hil_sim.world.files import load_world  # noqa: E402

FOLDER: Final = ROOT / "docs/img/diagrams"
CHAR, LINE, PAD, SMALL = 8.7, 19, 12, 6.4
INK, EDGE, FILL, PAPER, SOFT = "#16202c", "#2b6cb0", "#e8f1fb", "#ffffff", "#4a5a6c"


@dataclass(frozen=True)
class Flow:
    """Boxes in columns, and arrows: (from, to, words), by the first line of a box; `<` before words: both ways."""

    columns: tuple[tuple[str, ...], ...]
    arrows: tuple[tuple[str, str, str], ...]


@dataclass(frozen=True)
class Bytes:
    """A row of fields: (name, what it is)."""

    fields: tuple[tuple[str, str], ...]


FLOWS: Final[dict[str, Flow | Bytes]] = {
    "argusd": Flow(
        (
            ("robot",),
            ("argusd",),
            ("screen, keys", "control socket", "guard port", "recording", "CAN frames"),
        ),
        (
            ("robot", "argusd", "<ARCOS"),
            ("argusd", "screen, keys", ""),
            ("argusd", "control socket", ""),
            ("argusd", "guard port", ""),
            ("argusd", "recording", ""),
            ("argusd", "CAN frames", ""),
        ),
    ),
    "arcos": Bytes(
        (
            ("FA", "header"),
            ("FB", "header"),
            ("COUNT", "bytes after it"),
            ("data", "command or type first"),
            ("sum high", "checksum"),
            ("sum low", "checksum"),
        )
    ),
    "can": Flow(
        (("robot\nserial line",), ("gateway\nCAN to serial",), ("CAN bus",), ("argusd", "vehicle")),
        (
            ("robot", "gateway", "<ARCOS"),
            ("gateway", "CAN bus", "<ISO-TP"),
            ("CAN bus", "argusd", "<"),
            ("CAN bus", "vehicle", "<"),
        ),
    ),
    "control": Flow(
        (
            ("robot",),
            ("argusd\n--control PLACE",),
            ("argusctl", "argusd --attach", "argus-monitor", "argus-ros", "your program"),
        ),
        (
            ("robot", "argusd", "<"),
            *(
                ("argusd", name, "<")
                for name in ("argusctl", "argusd --attach", "argus-monitor", "argus-ros", "your program")
            ),
        ),
    ),
    "emulator": Flow(
        (
            ("scenario", "world", "faults"),
            ("argus-sim\na robot's body and sonars",),
            ("pseudo-terminal", "TCP", "CAN", "page"),
        ),
        (
            ("scenario", "argus-sim", ""),
            ("world", "argus-sim", ""),
            ("faults", "argus-sim", ""),
            *(("argus-sim", name, "") for name in ("pseudo-terminal", "TCP", "CAN", "page")),
        ),
    ),
    "events": Flow(
        (("HEALTHY",), ("SUSPECT",), ("DISABLED",), ("PROBATION",)),
        (
            ("HEALTHY", "SUSPECT", "<doubt, cleared"),
            ("SUSPECT", "DISABLED", "proof"),
            ("DISABLED", "PROBATION", "<reads again"),
        ),
    ),
    "flash": Flow(
        (
            ("tools/dev firmware",),
            ("image\nELF, HEX, BIN",),
            ("tools/dev flash",),
            ("probe", "serial", "DFU"),
            ("board",),
        ),
        (
            ("tools/dev firmware", "image", ""),
            ("image", "tools/dev flash", ""),
            *(("tools/dev flash", name, "") for name in ("probe", "serial", "DFU")),
            *((name, "board", "") for name in ("probe", "serial", "DFU")),
        ),
    ),
    "guardian": Flow(
        (
            ("old client\nARIA, p2os, Player",),
            ("guard port\nS1 to S7 on each order",),
            ("fault manager",),
            ("robot",),
        ),
        (
            ("old client", "guard port", "<ARCOS"),
            ("guard port", "fault manager", "<"),
            ("fault manager", "robot", "<ARCOS"),
        ),
    ),
    "manager": Flow(
        (
            ("Monitor\narcos, knowledge",),
            ("Analyse\nawareness, analysis",),
            ("Plan\nadjustment",),
            ("Execute\nbehaviour, supervisor",),
        ),
        (
            ("Monitor", "Analyse", "readings"),
            ("Analyse", "Plan", "verdicts"),
            ("Plan", "Execute", "rotations"),
        ),
    ),
    "packages": Flow(
        (
            ("source tree",),
            ("wheel", "Debian packages", "container"),
            ("Python, page, argusd", "service, C library, tools", "argusd alone"),
        ),
        (
            ("source tree", "wheel", ""),
            ("source tree", "Debian packages", ""),
            ("source tree", "container", ""),
            ("wheel", "Python, page, argusd", ""),
            ("Debian packages", "service, C library, tools", ""),
            ("container", "argusd alone", ""),
        ),
    ),
    "peers": Flow(
        (("ARIA programs", "p2os, rosaria", "Player", "argusd"), ("argus-sim", "guard port", "MobileSim")),
        (
            ("ARIA programs", "argus-sim", ""),
            ("ARIA programs", "guard port", ""),
            ("p2os, rosaria", "argus-sim", ""),
            ("p2os, rosaria", "guard port", ""),
            ("Player", "argus-sim", ""),
            ("Player", "guard port", ""),
            ("argusd", "MobileSim", ""),
        ),
    ),
    "porting": Flow(
        (
            ("UART", "clock", "record store"),
            ("hal/myboard/port.c\nsix functions",),
            ("hal/board",),
            ("firmware/\nargus.h",),
        ),
        (
            ("UART", "hal/myboard/port.c", "<"),
            ("clock", "hal/myboard/port.c", ""),
            ("record store", "hal/myboard/port.c", "<"),
            ("hal/myboard/port.c", "hal/board", "<"),
            ("hal/board", "firmware/", "<bytes, ms"),
        ),
    ),
    "python": Flow(
        (
            ("argus.live", "argus.sil", "argus.log", "argus.ranges", "argus.protocol"),
            (
                "a running argusd",
                "a drive in one process",
                "logs and bags",
                "any robot's ranges",
                "ARCOS packets",
            ),
        ),
        (
            ("argus.live", "a running argusd", "<"),
            ("argus.sil", "a drive in one process", ""),
            ("argus.log", "logs and bags", ""),
            ("argus.ranges", "any robot's ranges", ""),
            ("argus.protocol", "ARCOS packets", "<"),
        ),
    ),
    "ring": Flow(
        (
            ("bag", "table, JSON", "URDF"),
            ("ring file\nbearings, body",),
            ("argus-log", "argusd --ring", "ROS node"),
        ),
        (
            ("bag", "ring file", ""),
            ("table, JSON", "ring file", ""),
            ("URDF", "ring file", "draft"),
            ("ring file", "argus-log", ""),
            ("ring file", "argusd --ring", ""),
            ("ring file", "ROS node", ""),
        ),
    ),
    "ros": Flow(
        (
            ("robot", "any driver"),
            ("argusd", "argus-range-guard"),
            ("argus-ros", "ranges repaired"),
            ("ROS 2 graph",),
        ),
        (
            ("robot", "argusd", "<"),
            ("argusd", "argus-ros", "<"),
            ("argus-ros", "ROS 2 graph", "<"),
            ("any driver", "argus-range-guard", "Range"),
            ("argus-range-guard", "ranges repaired", ""),
            ("ranges repaired", "ROS 2 graph", ""),
        ),
    ),
    "requirements": Flow(
        (
            ("safety rules", "the paper", "README"),
            ("promise\ntests/requirements.toml",),
            ("its tests",),
            ("a gap fails the build",),
        ),
        (
            ("safety rules", "promise", ""),
            ("the paper", "promise", ""),
            ("README", "promise", ""),
            ("promise", "its tests", ""),
            ("its tests", "a gap fails the build", ""),
        ),
    ),
    "misra": Flow(
        (
            ("firmware/",),
            ("cppcheck\naddon misra",),
            ("listed with a reason", "any other"),
            ("fails",),
        ),
        (
            ("firmware/", "cppcheck", ""),
            ("cppcheck", "listed with a reason", ""),
            ("cppcheck", "any other", ""),
            ("any other", "fails", ""),
        ),
    ),
    "trust": Flow(
        (
            ("unit tests", "proofs, analysers", "monitor S1 to S8"),
            ("firmware/",),
            ("a figure\neach by a command",),
            ("below its floor\nthe build fails",),
        ),
        (
            ("unit tests", "firmware/", ""),
            ("proofs, analysers", "firmware/", ""),
            ("monitor S1 to S8", "firmware/", ""),
            ("firmware/", "a figure", ""),
            ("a figure", "below its floor", ""),
        ),
    ),
    "safety-monitor": Flow(
        (
            ("truth", "wire, both directions", "events"),
            ("tests/oracle/safety.c\nS1 to S8, written apart",),
            ("breaches",),
        ),
        (
            ("truth", "tests/oracle/safety.c", ""),
            ("wire, both directions", "tests/oracle/safety.c", ""),
            ("events", "tests/oracle/safety.c", ""),
            ("tests/oracle/safety.c", "breaches", ""),
        ),
    ),
    "sil": Flow(
        (
            ("libargus.so\nthe fault manager",),
            ("serial line\nof baud",),
            ("emulated robot",),
            ("world, faults",),
        ),
        (
            ("libargus.so", "serial line", "<"),
            ("serial line", "emulated robot", "<"),
            ("world, faults", "emulated robot", ""),
        ),
    ),
    "api-c": Flow(
        (
            ("bytes, ms",),
            ("argus_receive\nargus_process",),
            ("argus_transmit", "argus_next_event", "argus_status"),
            ("bytes to the robot", "events", "state"),
        ),
        (
            ("bytes, ms", "argus_receive", ""),
            *(("argus_receive", name, "") for name in ("argus_transmit", "argus_next_event", "argus_status")),
            ("argus_transmit", "bytes to the robot", ""),
            ("argus_next_event", "events", ""),
            ("argus_status", "state", ""),
        ),
    ),
    "evidence": Flow(
        (
            ("ping",),
            ("own tests", "cross-check", "clutter"),
            ("facts\nnats",),
            ("suspect",),
            ("named",),
            ("given up",),
        ),
        (
            ("ping", "own tests", ""),
            ("ping", "cross-check", ""),
            ("ping", "clutter", ""),
            ("own tests", "facts", ""),
            ("cross-check", "facts", ""),
            ("clutter", "facts", ""),
            ("facts", "suspect", ""),
            ("suspect", "named", ""),
            ("named", "given up", ""),
        ),
    ),
    "driving": Flow(
        (("sonars out",), ("policy",), ("rotations",), ("sweep", "weave"), ("step or drive",)),
        (
            ("sonars out", "policy", ""),
            ("policy", "rotations", ""),
            ("rotations", "sweep", ""),
            ("rotations", "weave", ""),
            ("sweep", "step or drive", "S1 to S8"),
            ("weave", "step or drive", ""),
        ),
    ),
    "design": Flow(
        (
            ("robot\nor hil_sim",),
            ("hal/\nlink, clock, store",),
            ("arcos", "knowledge", "awareness"),
            ("analysis", "adjustment", "task"),
            ("behaviour",),
            ("supervisor",),
            ("events\nscreen, JSON, CAN, socket",),
        ),
        (
            ("robot", "hal/", "<ARCOS"),
            ("hal/", "arcos", "bytes, ms"),
            ("arcos", "knowledge", ""),
            ("knowledge", "awareness", ""),
            ("awareness", "analysis", ""),
            ("analysis", "adjustment", ""),
            ("adjustment", "behaviour", ""),
            ("task", "behaviour", ""),
            ("behaviour", "supervisor", "intents"),
            ("supervisor", "events", ""),
        ),
    ),
}


def wide(label: str) -> float:
    """Return how much room a box needs."""
    first, *rest = label.split("\n")
    return max(CHAR * len(first), *(SMALL * len(line) for line in rest), 0.0) + 2 * PAD


def high(label: str) -> float:
    """Return the height of a box."""
    return LINE * len(label.split("\n")) + PAD


def text(x: float, y: float, words: str, size: float = 14, colour: str = INK, weight: int = 400) -> str:
    """Return a line of text, centred."""
    style = f'font-size="{size}" font-weight="{weight}" fill="{colour}" text-anchor="middle"'
    return f'<text x="{x:.0f}" y="{y:.0f}" {style}>{escape(words)}</text>'


def page(width: float, height: float, parts: list[str]) -> str:
    """Return the file; a ground of its own, for a page may be dark."""
    size = f"{width:.0f} {height:.0f}"
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size}" width="{width:.0f}" height="{height:.0f}"'
    arrow = (
        '<defs><marker id="a" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="8" markerHeight="8" '
        f'orient="auto-start-reverse"><path d="M0 0L8 4L0 8Z" fill="{EDGE}"/></marker></defs>'
    )
    inner = f'width="{width - 2:.0f}" height="{height - 2:.0f}"'
    ground = f'<rect x="1" y="1" {inner} rx="10" fill="{PAPER}" stroke="#c3ccd6"/>'
    opened = f'{head} font-family="system-ui, Segoe UI, Helvetica, Arial, sans-serif">'
    return "\n".join([opened, "<!-- drawn by tools/gen_diagrams.py -->", arrow, ground, *parts, "</svg>\n"])


def box(x: float, y: float, width: float, label: str) -> list[str]:
    """Return a box with its lines; x and y are its middle."""
    tall = high(label)
    corner = f'x="{x - width / 2:.0f}" y="{y - tall / 2:.0f}"'
    parts = [f'<rect {corner} width="{width:.0f}" height="{tall:.0f}" rx="6" fill="{FILL}" stroke="{EDGE}"/>']
    first, *rest = label.split("\n")
    top = y - tall / 2 + PAD / 2 + 14
    parts.append(text(x, top, first, weight=600))
    return parts + [text(x, top + LINE * (k + 1), line, 12, SOFT) for k, line in enumerate(rest)]


def flow(drawn: Flow) -> str:
    """Return a flow as SVG."""
    names = [[label.split("\n")[0] for label in column] for column in drawn.columns]
    column_of = {name: k for k, column in enumerate(names) for name in column}
    widths = [max(map(wide, column)) for column in drawn.columns]
    gaps = [34.0] * (len(widths) - 1)
    for near, far, words in drawn.arrows:
        at, to = sorted((column_of[near], column_of[far]))
        if to == at + 1:
            gaps[at] = max(gaps[at], SMALL * len(words.lstrip("<")) + 26)
    lefts = list(itertools.accumulate([16.0, *(w + g for w, g in zip(widths, gaps, strict=False))]))
    tall = max(sum(high(label) + 14 for label in column) for column in drawn.columns) + 14
    middle: dict[str, tuple[float, float, float, float]] = {}
    parts: list[str] = []
    for column, left, width in zip(drawn.columns, lefts, widths, strict=True):
        y = tall / 2 - sum(high(label) + 14 for label in column) / 2 + 7
        for label in column:
            place = left + width / 2, y + high(label) / 2
            middle[label.split("\n")[0]] = (*place, width, high(label))
            parts += box(*place, width, label)
            y += high(label) + 14
    for near, far, words in drawn.arrows:
        (x1, y1, w1, h1), (x2, y2, w2, h2) = middle[near], middle[far]
        if x1 == x2:
            y1, y2 = (y1 + h1 / 2, y2 - h2 / 2) if y2 > y1 else (y1 - h1 / 2, y2 + h2 / 2)
        else:
            x1, x2 = (x1 + w1 / 2, x2 - w2 / 2) if x2 > x1 else (x1 - w1 / 2, x2 + w2 / 2)
        both = ' marker-start="url(#a)"' if words.startswith("<") else ""
        ends = f'd="M{x1:.0f} {y1:.0f}L{x2:.0f} {y2:.0f}"'
        parts.append(
            f'<path {ends} stroke="{EDGE}" stroke-width="1.6" fill="none" marker-end="url(#a)"{both}/>'
        )
        if words.lstrip("<"):
            parts.append(text((x1 + x2) / 2, (y1 + y2) / 2 - 6, words.lstrip("<"), 12, SOFT))
    return page(lefts[-1] + widths[-1] + 16, tall, parts)


def fields(drawn: Bytes) -> str:
    """Return a row of bytes as SVG."""
    parts: list[str] = []
    x = 16.0
    for name, what in drawn.fields:
        width = max(wide(name), SMALL * len(what) + 16)
        parts.append(
            f'<rect x="{x:.0f}" y="18" width="{width:.0f}" height="36" fill="{FILL}" stroke="{EDGE}"/>'
        )
        parts += [text(x + width / 2, 41, name, weight=600), text(x + width / 2, 72, what, 12, SOFT)]
        x += width
    return page(x + 16, 88, parts)


def floor(name: str, course: list[tuple[float, float]], left: float, tall: float) -> tuple[list[str], float]:
    """Return the plan of a world, and its width: solids, start, and the course if there is one."""
    world = load_world(name)
    x1, y1, x2, y2 = world.bounds
    scale = (tall - 60) / (y2 - y1)

    def at(x: float, y: float) -> str:
        return f"{left + (x - x1) * scale:.0f} {18 + (y2 - y) * scale:.0f}"

    parts = [
        f'<path d="M{at(ax, ay)}L{at(bx, by)}" stroke="{INK}" stroke-width="2" stroke-linecap="round"/>'
        for ax, ay, bx, by in world.segments.tolist()
    ]
    start = world.start
    if course:
        way = "L".join(at(x, y) for x, y in [(start.x_mm, start.y_mm), *course])
        parts.append(f'<path d="M{way}" stroke="{EDGE}" stroke-width="2" fill="none" marker-end="url(#a)"/>')
    x, y = at(start.x_mm, start.y_mm).split()
    parts.append(f'<circle cx="{x}" cy="{y}" r="5" fill="#c53030"/>')
    width = max((x2 - x1) * scale, CHAR * len(name))
    metres = f"{(x2 - x1) / 1000:.1f} by {(y2 - y1) / 1000:.1f} m"
    parts.append(text(left + width / 2, tall - 22, name, weight=600))
    parts.append(text(left + width / 2, tall - 7, metres, 12, SOFT))
    return parts, width


def floors(names: tuple[str, ...], tall: float, with_course: bool) -> str:
    """Return plans of worlds beside one another."""
    parts: list[str] = []
    left = 18.0
    for name in names:
        course = [(float(x), float(y)) for x, y in load_scenario(name).course] if with_course else []
        drawn, width = floor(name, course, left, tall)
        parts += drawn
        left += width + 26
    return page(left - 8, tall, parts)


def drawings() -> dict[Path, str]:
    """Return each file with what it is to hold."""
    return {
        FOLDER / f"{name}.svg": flow(drawn) if isinstance(drawn, Flow) else fields(drawn)
        for name, drawn in FLOWS.items()
    } | {
        FOLDER / "worlds.svg": floors(("demo", "lab", "open-office"), 230, False),
        FOLDER / "scenarios.svg": floors(("demo", "box-ahead", "open-office"), 230, True),
    }


def main() -> int:
    """Write the files, or with --check compare them."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "--check", action="store_true", help="change nothing; exit 1 where a file is out of date"
    )
    check = parser.parse_args().check
    stale = [
        path
        for path, svg in drawings().items()
        if not path.exists() or path.read_text(encoding="utf-8") != svg
    ]
    for path in stale:
        if check:
            print(f"{path.relative_to(ROOT)}: out of date; run tools/gen_diagrams.py", file=sys.stderr)
        else:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(drawings()[path], encoding="utf-8")
    return int(check and bool(stale))


if __name__ == "__main__":
    sys.exit(main())
