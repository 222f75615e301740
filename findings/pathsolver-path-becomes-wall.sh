#!/bin/sh
# SPDX-License-Identifier: MIT
# pathsolver draws its path into the maze that it was given, and the next search takes the path for a wall.
#
# Version:   pathsolver 1.0.1.
# Expected:  solve() works on a copy, as its code says, and a second search in the same maze finds a path, too.
# Behaviour: Only the list of rows is copied, not the rows. Each cell of the path is "*" in the maze of the caller, and
#            all that is not 0 is a wall, so a second robot goes around where the first one went.
# Hurts:     Anyone who plans again, or for a second robot: paths become longer with each search until there is none.
#            Astar() leaves the maze as it is, and copy.deepcopy helps.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pathsolver==1.0.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >maze.py <<'END'
import contextlib
import io

from pathsolver import Astar, solve

maze = [[0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]]
with contextlib.redirect_stdout(io.StringIO()):
    _, path = solve(maze, (1, 0), (1, 3))
print("path:", path)
print("maze:", ["".join(str(cell) for cell in row) for row in maze])
print("across it afterwards:", Astar(maze, (0, 0), (0, 3)))
print("free cells from start to goal:", [maze[y][x] == 0 for y, x in path])
END
venv/bin/python maze.py >seen

cat >expected <<'END'
path: [(1, 0), (1, 1), (1, 2), (1, 3)]
maze: ['0000', '****', '0000']
across it afterwards: [(0, 0), (0, 1), (0, 2), (0, 3)]
free cells from start to goal: [False, False, False, False]
END
diff expected seen || { echo "CHANGED: pathsolver-path-becomes-wall" >&2; exit 1; }
echo "PASS: after one search the maze has a wall more"
