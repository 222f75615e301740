# SPDX-License-Identifier: MIT
"""Circles in a graph of files or packages."""

from __future__ import annotations

Graph = dict[str, set[str]]


def reach(graph: Graph, start: str) -> set[str]:
    """Return all files that one leads to, itself only where a way leads back."""
    seen: set[str] = set()
    waiting = list(graph.get(start, ()))
    while waiting:
        file = waiting.pop()
        if file not in seen:
            seen.add(file)
            waiting.extend(graph.get(file, ()))
    return seen


def circles(graph: Graph) -> set[frozenset[str]]:
    """Return the sets of files each of which leads to each other."""
    led = {file: reach(graph, file) for file in graph}
    return {
        frozenset(other for other in led[file] if file in led.get(other, set()))
        for file in graph
        if file in led[file]
    }
