#!/bin/sh
# SPDX-License-Identifier: MIT
# In pyrobosim a map whose white is 255 is all wall once it is saved again, and walls that are not quite black are
# free.
#
# Version:   pyrobosim 5.0.1, numpy 2.4.6, shapely 2.2.0.
# Expected:  The grey values of a map are turned into probabilities and held against the thresholds of its file.
# Behaviour: Three values are known, 0, 205 and 254; any other stays as it is. Planning takes 1 alone for occupied,
#            whatever the threshold, so that 255 and 10 are free, and so is a cell set to 0.9. Saving takes all from
#            the threshold on for wall: 255 and 10 both.
# Hurts:     Anyone who has touched up a map in an editor, which writes 255 and soft edges, or keeps probabilities in a
#            grid.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            pyrobosim==5.0.1 \
            numpy==2.4.6 \
            shapely==2.2.0 \
            transforms3d==0.4.2 \
            astar==0.99 \
            sortedcontainers==2.4.0 \
            PyYAML==6.0.4 \
            pillow==13.0.0 \
            typing_extensions==4.16.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >white.py <<'END'
import pathlib
import sys
from unittest.mock import MagicMock

import numpy
from PIL import Image

for name in ("plotly", "plotly.graph_objects", "plotly.colors", "trimesh", "collada", "scipy", "scipy.spatial", "dash"):
    sys.modules[name] = MagicMock()  # to draw and to grasp with

from pyrobosim.navigation.occupancy_grid import OccupancyGrid

greys = (0, 10, 205, 254, 255)
Image.fromarray(numpy.array([greys], numpy.uint8)).save("map.pgm")
with open("map.yaml", "w") as file:
    file.write("image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n")
grid = OccupancyGrid.from_file(pathlib.Path("."), "map")
grid.save_to_file(pathlib.Path("."), "again")
saved = numpy.array(Image.open("again.pgm"))[0]
for column, grey in enumerate(greys):
    print(f"{grey}: occupied {grid.is_occupied((column, 0))}, saved as {saved[column]}")
grid = OccupancyGrid(numpy.array([[0.1, 0.9, 1.0]]), 0.05, occ_thresh=0.65)
print("0.1, 0.9, 1.0: occupied", [bool(grid.is_occupied((0, row))) for row in range(3)])
print("a straight line over 0.9:", grid.has_straight_line_connection((0, 0), (0, 1))[0])
END
venv/bin/python white.py >seen

cat >expected <<'END'
0: occupied True, saved as 0
10: occupied False, saved as 0
205: occupied False, saved as 205
254: occupied False, saved as 254
255: occupied False, saved as 0
0.1, 0.9, 1.0: occupied [False, False, True]
a straight line over 0.9: True
END
diff expected seen || { echo "CHANGED: pyrobosim-white-becomes-wall" >&2; exit 1; }
echo "PASS: white of 255 is free for planning and saved as 0"
