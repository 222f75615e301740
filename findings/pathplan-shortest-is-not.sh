#!/bin/sh
# SPDX-License-Identifier: MIT
# Neither A* nor jump point search of pathplan finds the shortest path, and the latter misses paths that exist.
#
# Version:   pathplan 0.1.0, numpy 2.4.6.
# Expected:  Both are exact on a grid with eight neighbours: they return paths of one length, that of Dijkstra, or both
#            none.
# Behaviour: A* estimates by the Manhattan distance, which is too far where diagonals are allowed, so it settles for
#            longer paths. Jump point search skips cells at which it has to turn: it is longer elsewhere, and finds
#            none at all in some maps that A* crosses.
# Hurts:     Anyone who compares planners by it, or takes 'no path' for a closed door.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pathplan==0.1.0 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >lengths.py <<'END'
import heapq
import itertools
import math

import numpy as np
from pathplan.classic.a_star import AStarPlanner
from pathplan.classic.jps import JPSPlanner
from pathplan.core.map import GridMap

SIZE = 20
STEPS = [step for step in itertools.product((-1, 0, 1), repeat=2) if any(step)]


def shortest(cells):
    """Return the length by Dijkstra: eight neighbours, each free cell may be entered."""
    best, heap = {(0, 0): 0.0}, [(0.0, (0, 0))]
    while heap:
        length, cell = heapq.heappop(heap)
        if cell == (SIZE - 1, SIZE - 1):
            return length
        for step in STEPS:
            there = cell[0] + step[0], cell[1] + step[1]
            longer = length + math.hypot(*step)
            if 0 <= min(there) and max(there) < SIZE and not cells[there] and longer < best.get(there, math.inf):
                best[there] = longer
                heapq.heappush(heap, (longer, there))
    return None


def length_of(path):
    return sum(math.dist(a, b) for a, b in itertools.pairwise(path))


maps, counts = 0, {planner: [0, 0] for planner in (AStarPlanner, JPSPlanner)}
for seed in range(20):
    cells = (np.random.default_rng(seed).random((SIZE, SIZE)) < 0.25).astype(float)
    cells[0, 0] = cells[-1, -1] = 0
    exact = shortest(cells)
    if exact is None:
        continue
    maps += 1
    for planner, count in counts.items():
        path, _ = planner(GridMap(cells)).plan((0, 0), (SIZE - 1, SIZE - 1))
        count[0] += path is not None and length_of(path) > exact + 1e-6
        count[1] += path is None
for planner, (longer, none) in counts.items():
    print(f"{planner.__name__}: of {maps} maps with a path {longer} longer than the shortest, {none} without a path")
END
venv/bin/python lengths.py >seen

cat >expected <<'END'
AStarPlanner: of 20 maps with a path 12 longer than the shortest, 0 without a path
JPSPlanner: of 20 maps with a path 7 longer than the shortest, 3 without a path
END
diff expected seen || { echo "CHANGED: pathplan-shortest-is-not" >&2; exit 1; }
echo "PASS: the planners return longer paths, or none"
