#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Worst-case stack of a C library, from the call graphs that gcc writes with -fcallgraph-info=su,da."""

from __future__ import annotations

import argparse
import dataclasses
import re
import sys
from collections.abc import Sequence
from pathlib import Path

EPILOG = """examples:
  tools/size_stack.py build/cortex-m4
  tools/size_stack.py build/cortex-m4 --root argus_receive --root argus_process
  tools/size_stack.py FOLDER --root main --pointer slot_read --pointer slot_write

exit codes: 0 bounded, 1 recursion, a call through a pointer, or a frame whose size is not fixed,
            2 no call graphs there"""

NODE = re.compile(r'node: \{ title: "(?P<title>[^"]+)" label: "(?P<label>[^"]*)"')
EDGE = re.compile(r'edge: \{ sourcename: "(?P<source>[^"]+)" targetname: "(?P<target>[^"]+)"')
FRAME = re.compile(r"(?P<bytes>\d+) bytes \((?P<kind>[^)]*)\)")
SPECIALISED = re.compile(r"(\.(constprop|isra|part|cold|lto_priv)(\.\d+)?)+$")
INDIRECT = "__indirect_call"


class Unbounded(Exception):
    """The stack has no fixed bound; the message says where."""


@dataclasses.dataclass
class Graph:
    """Frames (bytes) of the functions defined here, and which calls which."""

    frames: dict[str, int] = dataclasses.field(default_factory=dict)
    calls: dict[str, set[str]] = dataclasses.field(default_factory=dict)

    def named(self, name: str) -> list[str]:
        """Return the functions here of that own name."""
        return sorted(title for title in self.frames if short(title) == name)

    def point(self, names: Sequence[str]) -> None:
        """Take all calls through pointers for calls of the functions NAMES; one that is not here is an error."""
        targets = {title for name in names for title in self.named(name)}
        missing = [name for name in names if not self.named(name)]
        if missing:
            raise Unbounded(f"no function '{missing[0]}' here, so it cannot be what a pointer leads to")
        for called in self.calls.values():
            if INDIRECT in called:
                called.remove(INDIRECT)
                called |= targets

    def add(self, text: str) -> None:
        """Add one call graph file."""
        for node in NODE.finditer(text):
            frame = FRAME.search(node["label"])
            if frame is None:
                continue
            if frame["kind"] != "static":
                raise Unbounded(f"{short(node['title'])} has a frame of no fixed size ({frame['kind']})")
            self.frames[node["title"]] = int(frame["bytes"])
        for edge in EDGE.finditer(text):
            self.calls.setdefault(edge["source"], set()).add(edge["target"])

    def public(self) -> list[str]:
        """Return the functions that can be called from outside; gcc prefixes the file to the others."""
        return sorted(title for title in self.frames if ":" not in title)

    def unknown(self) -> list[str]:
        """Return the functions called but defined elsewhere."""
        called = set().union(*self.calls.values()) if self.calls else set()
        return sorted(called - set(self.frames) - {INDIRECT})


@dataclasses.dataclass(frozen=True)
class Depth:
    """Bytes of stack below and including a function, and the calls that need them."""

    bytes: int
    path: tuple[str, ...]


def short(title: str) -> str:
    """Return the function's own name, without what gcc adds when it specialises it."""
    return SPECIALISED.sub("", title.rsplit(":", 1)[-1])


def deepest(graph: Graph, root: str, known: dict[str, Depth], above: tuple[str, ...] = ()) -> Depth:
    """Return the deepest chain of calls from ROOT; KNOWN holds finished results."""
    if root in above:
        raise Unbounded(
            "recursion: " + " > ".join(short(name) for name in (*above[above.index(root) :], root))
        )
    if root == INDIRECT:
        raise Unbounded(f"{short(above[-1])} calls through a pointer")
    if root not in known:
        below = [deepest(graph, name, known, (*above, root)) for name in sorted(graph.calls.get(root, ()))]
        worst = max(below, key=lambda depth: depth.bytes, default=Depth(0, ()))
        known[root] = Depth(graph.frames.get(root, 0) + worst.bytes, (root, *worst.path))
    return known[root]


def load(folder: Path) -> Graph:
    """Return the call graph of all .ci files below FOLDER."""
    files = sorted(folder.rglob("*.ci"))
    if not files:
        raise FileNotFoundError(f"{folder}: no .ci files; run tools/dev build cortex-m4")
    graph = Graph()
    for file in files:
        graph.add(file.read_text(encoding="utf-8"))
    return graph


def report(graph: Graph, roots: list[str], rows: int = 8) -> list[str]:
    """Return the lines that tell the worst stack from ROOTS (all public functions when empty)."""
    known: dict[str, Depth] = {}
    # Every function is visited, so that no recursion hides in one that no root reaches.
    for name in sorted(graph.frames):
        deepest(graph, name, known)
    depths = sorted((known[root] for root in roots or graph.public()), key=lambda d: (-d.bytes, d.path))
    lines = [f"{depth.bytes:7} {short(depth.path[0])}" for depth in depths[:rows]]
    if depths:
        lines.append("deepest: " + " > ".join(f"{short(n)} {graph.frames.get(n, 0)}" for n in depths[0].path))
    lines.append("library functions, counted as 0: " + (", ".join(graph.unknown()) or "none"))
    return lines


def main(argv: list[str] | None = None) -> int:
    """Run the command line and return its exit code."""
    parser = argparse.ArgumentParser(
        prog="tools/size_stack.py",
        description=__doc__,
        epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("folder", type=Path, help="build folder that holds the .ci files")
    parser.add_argument(
        "--root", action="append", default=[], help="function to start from (default: all public)"
    )
    parser.add_argument(
        "--pointer",
        action="append",
        default=[],
        metavar="FUNCTION",
        help="what a call through a pointer may reach",
    )
    args = parser.parse_args(argv)
    try:
        graph = load(args.folder)
        if args.pointer:
            graph.point(args.pointer)
        missing = [root for root in args.root if root not in graph.frames]
        if missing:
            raise FileNotFoundError(f"{args.folder}: no function '{missing[0]}'")
        lines = report(graph, args.root)
    except FileNotFoundError as error:
        print(f"size_stack: {error}", file=sys.stderr)
        return 2
    except Unbounded as error:
        print(f"size_stack: {error}", file=sys.stderr)
        return 1
    print("\n".join(lines))
    return 0


if __name__ == "__main__":
    sys.exit(main())
