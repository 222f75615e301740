#!/bin/sh
# SPDX-License-Identifier: MIT
# graphslam holds the pose on the first line of a g2o file, not the one that the file fixes, and writes the file
# without it.
#
# Version:   graphslam 0.0.17, scipy 1.17.1, numpy 2.4.6.
# Expected:  FIX 0 keeps vertex 0 where it is; or, without support for it, the vertex with the smallest number is kept.
# Behaviour: The line is passed over with a warning of the logging module. optimize() holds the vertex that stands
#            first in the file, whatever its number, and moves all others to it. The vertex stays marked for later
#            calls with fix_first_pose=False, and to_g2o() writes no FIX.
# Hurts:     Anyone who sorts a graph otherwise, or appends a new origin: the whole map is moved to where the last
#            guess of one pose was.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            graphslam==0.0.17 \
            scipy==1.17.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >fix.py <<'END'
import logging

from graphslam.graph import Graph

logging.disable()
LINES = {
    "robot": "VERTEX_SE2 7 5 5 0",
    "origin": "VERTEX_SE2 0 0 0 0",
    "between": "VERTEX_SE2 1 1.2 0 0",
}
REST = """FIX 0
EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1
EDGE_SE2 1 7 1 0 0 1 0 0 1 0 1
"""

for order in (("origin", "between", "robot"), ("robot", "origin", "between")):
    with open("graph.g2o", "w") as file:
        file.write("\n".join(LINES[name] for name in order) + "\n" + REST)
    graph = Graph.from_g2o("graph.g2o")
    graph.optimize(verbose=False)
    graph.to_g2o("again.g2o")
    print("first in the file:", order[0])
    for vertex in sorted(graph._vertices, key=lambda v: v.id):
        x, y, _ = (round(float(v), 3) + 0 for v in vertex.pose.to_array())
        print(f"    vertex {vertex.id}: x {x}, y {y}")
with open("again.g2o") as file:
    print("FIX in the file written:", "FIX" in file.read())
END
venv/bin/python fix.py >seen

cat >expected <<'END'
first in the file: origin
    vertex 0: x 0.0, y 0.0
    vertex 1: x 1.0, y 0.0
    vertex 7: x 2.0, y 0.0
first in the file: robot
    vertex 0: x 3.0, y 5.0
    vertex 1: x 4.0, y 5.0
    vertex 7: x 5.0, y 5.0
FIX in the file written: False
END
diff expected seen || { echo "CHANGED: graphslam-fixes-the-first-line" >&2; exit 1; }
echo "PASS: the first line of the file is what stays in place"
