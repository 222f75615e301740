#!/bin/sh
# SPDX-License-Identifier: MIT
# astar-python finds no path across a floor without walls: cells that it has taken from its list and not used are lost.
#
# Version:   astar-python 0.1.0.
# Expected:  Where no cell is None each cell can be reached, whatever the weights are, and None is the answer for no
#            path.
# Behaviour: The last cell of the list is taken out, a better one is looked for, and the first is not put back. Of 300
#            random floors with weights of 1 to 9 about a fifth have no path, and some mazes without weights, too.
# Hurts:     Anyone who takes None for a closed door, or weighs cells by their distance from walls. Another planner, or
#            weights that are all equal on an open floor.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            astar-python==0.1.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >floor.py <<'END'
import random

from astar_python import Astar

FLOORS = {
    "all 1": [[1, 1, 1], [1, 1, 1], [1, 1, 1]],
    "with weights": [[1, 5, 1], [1, 5, 1], [1, 1, 9]],
    "maze of 0, None is wall": [[0, None, 0, 0], [0, 0, None, 0], [0, 0, None, 0]],
}
for name, floor in FLOORS.items():
    print(f"{name}: {Astar(floor).run((0, 0), (len(floor[0]) - 1, 2))}")
random.seed(1)
floors = [[[random.choice((1, 1, 1, 5, 9)) for _ in range(4)] for _ in range(4)] for _ in range(300)]
print("of 300 floors without walls", sum(Astar(floor).run((0, 0), (3, 3)) is None for floor in floors), "have no path")
END
venv/bin/python floor.py >seen

cat >expected <<'END'
all 1: [[0, 0], [1, 1], [2, 2]]
with weights: None
maze of 0, None is wall: None
of 300 floors without walls 67 have no path
END
diff expected seen || { echo "CHANGED: astar-python-loses-cells" >&2; exit 1; }
echo "PASS: a floor of nine free cells has no path"
