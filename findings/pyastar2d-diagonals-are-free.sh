#!/bin/sh
# SPDX-License-Identifier: MIT
# pyastar2d plans across an empty floor by a zigzag 31 % longer than the straight line, and between two walls that
# touch.
#
# Version:   pyastar2d 1.1.4, numpy 2.4.6.
# Expected:  With allow_diagonal a diagonal step costs sqrt(2) of a straight one, and it does not pass between two
#            blocked cells that share a corner.
# Behaviour: Each step costs the weight of the cell entered, diagonal or not. Of all ways with equally many cells the
#            one taken swings out; the corner of two cells with infinite weight is crossed.
# Hurts:     Anyone who lets a robot follow such a path: it wanders in free space, and its body touches where two walls
#            meet.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pyastar2d==1.1.4 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >path.py <<'END'
import numpy as np
import pyastar2d

floor = np.ones((5, 9), np.float32)
path = pyastar2d.astar_path(floor, (2, 0), (2, 8), allow_diagonal=True)
length = np.hypot(*np.diff(path, axis=0).T).sum()
print("empty floor:", [tuple(map(int, cell)) for cell in path])
print(f"{length:.2f} cells long, straight it is 8")

wall = np.ones((4, 4), np.float32)
wall[0, 2] = wall[1, 2] = wall[2, 1] = wall[3, 1] = np.inf
path = pyastar2d.astar_path(wall, (0, 0), (3, 3), allow_diagonal=True)
print("a wall of cells that touch at a corner:", None if path is None else [tuple(map(int, cell)) for cell in path])
print("without diagonals:", pyastar2d.astar_path(wall, (0, 0), (3, 3), allow_diagonal=False))
END
venv/bin/python path.py >seen

cat >expected <<'END'
empty floor: [(2, 0), (2, 1), (3, 2), (4, 3), (3, 4), (4, 5), (3, 6), (2, 7), (2, 8)]
10.49 cells long, straight it is 8
a wall of cells that touch at a corner: [(0, 0), (1, 1), (2, 2), (3, 3)]
without diagonals: None
END
diff expected seen || { echo "CHANGED: pyastar2d-diagonals-are-free" >&2; exit 1; }
echo "PASS: the path over an empty floor is a zigzag"
