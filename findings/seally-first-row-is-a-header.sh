#!/bin/sh
# SPDX-License-Identifier: MIT
# seally takes the first row of a map for the names of its columns, so the upper wall is missing and all rows are one
# too high.
#
# Version:   seally 0.2.0, pygame 2.6.1, pandas 3.0.6, numpy 2.4.6.
# Expected:  A map of 5 by 5 cells in a CSV file without a header, as the program has no names for columns, is 5 by 5.
# Behaviour: It is 5 by 4. What was at the row 3 is at 2, and cells above the room are free or out of the map. GridMap()
#            without arguments raises AttributeError.
# Hurts:     Anyone who plans by coordinates of the file: a door is found one cell beside where it is, and the goal may
#            be in a wall. A line of names at the top of the file, or the wall twice, helps.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            seally==0.2.0 \
            pygame==2.6.1 \
            pandas==3.0.6 \
            numpy==2.4.6 \
            python-dateutil==2.9.0.post0 \
            six==1.17.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >map.py <<'END'
import os

os.environ["PYGAME_HIDE_SUPPORT_PROMPT"] = "1"

from seally.env.grid_map import GridCell, GridMap

ROOM = ["1,1,1,1,1", "1,0,0,0,1", "1,0,0,0,0", "1,0,0,0,1", "1,1,1,1,1"]


def show(name, lines):
    open("room.csv", "w").write("\n".join(lines) + "\n")
    grid = GridMap(gen_random=False, file_path="room.csv")
    door = [y for y in range(grid.y_dim) if not grid.is_occupied(GridCell(4, y))]
    print(f"{name}: {grid.x_dim} by {grid.y_dim}, door in row {door}, upper row", grid.map[0].tolist())


show("the room", ROOM)
show("with names above", ["a,b,c,d,e", *ROOM])
try:
    GridMap()
except AttributeError as error:
    print("GridMap(): AttributeError:", error)
END
venv/bin/python map.py >seen

cat >expected <<'END'
the room: 5 by 4, door in row [1], upper row [1, 0, 0, 0, 1]
with names above: 5 by 5, door in row [2], upper row [1, 1, 1, 1, 1]
GridMap(): AttributeError: 'GridMap' object has no attribute 'map'
END
diff expected seen || { echo "CHANGED: seally-first-row-is-a-header" >&2; exit 1; }
echo "PASS: a map of 5 rows has 4, without the upper wall"
