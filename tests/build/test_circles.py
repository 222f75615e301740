# SPDX-License-Identifier: MIT
"""Rule: no file of firmware/ is in a circle with another, by what it includes or by what it calls."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest
from graphs import Graph, circles

ROOT = Path(__file__).resolve().parents[2]
FIRMWARE = ROOT / "firmware"
OBJECTS = ROOT / "build/release/CMakeFiles/argus.dir/firmware"


def stem(path: Path) -> str:
    """Return what a header and its source have in common: awareness/own for firmware/awareness/own.c."""
    relative = path.relative_to(FIRMWARE)
    parts = relative.parts[1:] if relative.parts[0] == "include" else relative.parts
    return Path(*parts).with_suffix("").as_posix()


@cache
def includes() -> Graph:
    """Return for each file the files whose headers it includes."""
    found: Graph = {}
    for path in sorted(FIRMWARE.rglob("*.[ch]")):
        names = re.findall(r'#include "([\w/]+)\.h"', path.read_text(encoding="utf-8"))
        found.setdefault(stem(path), set()).update(set(names) - {stem(path)})
    return found


@cache
def calls() -> Graph:
    """Return for each source the sources whose symbols its object wants."""
    owner: dict[str, str] = {}
    wanted: dict[str, set[str]] = {}
    objects: dict[str, str] = {}
    for path in sorted(FIRMWARE.rglob("*.c")):
        file = OBJECTS / path.relative_to(FIRMWARE).with_suffix(".c.o")
        assert file.exists(), f"{file} is missing: run tools/dev build release"
        objects[str(file)] = stem(path)
    text = subprocess.run(["nm", "-A", *objects], check=True, stdout=subprocess.PIPE, text=True).stdout
    for file_name, kind, name in re.findall(r"^(.+?):.* ([A-Za-z]) (\w+)$", text, re.MULTILINE):
        if kind in "TDRBVW":
            owner[name] = objects[file_name]
        elif kind == "U":
            wanted.setdefault(objects[file_name], set()).add(name)
    return {file: {owner[name] for name in names if name in owner} for file, names in wanted.items()}


def joined() -> Graph:
    """Return both in one."""
    by_include, by_call = includes(), calls()
    return {file: by_include.get(file, set()) | by_call.get(file, set()) for file in by_include | by_call}


def test_a_circle_is_found() -> None:
    graph = {"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}, "e": {"e"}}
    assert circles(graph) == {frozenset("abc"), frozenset("e")}


@pytest.mark.parametrize("graph", [includes, calls, joined])
def test_no_circles_between_files(graph: Callable[[], Graph]) -> None:
    assert [sorted(circle) for circle in circles(graph())] == []


def test_every_source_calls_or_is_called() -> None:
    # An empty graph has no circles: the symbol tables were read.
    graph = calls()
    assert {"supervisor/modes", "knowledge/health", "adjustment/guard"} <= set().union(*graph.values())
