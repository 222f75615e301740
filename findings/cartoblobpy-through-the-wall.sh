#!/bin/sh
# SPDX-License-Identifier: MIT
# cartoblobpy plans through walls of one cell: the cells of an obstacle are nodes of its graph as soon as a free cell
# is beside them.
#
# Version:   cartoblobpy 0.0.10, networkx 3.6.1.
# Expected:  The graph has the free cells of the map, as its text says, and a room behind a closed wall is out of
#            reach.
# Behaviour: The edges of a free cell go to all eight neighbours, occupied or not, and adding an edge adds its node. A
#            wall of one cell is crossed; one of two cells is entered, not crossed.
# Hurts:     Anyone who plans on a map of 5 cm cells, where walls and glass are one cell thick.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            cartoblobpy==0.0.10 \
            networkx==3.6.1 \
            numpy==2.4.6 \
            pillow==13.0.0 \
            scipy==1.17.1 \
            PyYAML==6.0.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >wall.py <<'END'
import sys
from unittest.mock import MagicMock

import networkx
import numpy
from PIL import Image

for module in ("matplotlib", "matplotlib.pyplot", "matplotlib.colors"):
    sys.modules[module] = MagicMock()  # to draw with

from cartoblobpy.graph import Graph

for thick in (1, 2):
    picture = numpy.full((5, 9), 255, numpy.uint8)
    picture[:, 4 : 4 + thick] = 0  # a wall from edge to edge
    Image.fromarray(picture).save("map.png")
    map_ = Graph()
    map_.load_from_image("map.png")
    map_.build_graph()
    print(f"wall of {thick}: {int((picture > 0).sum())} free cells, {map_.nodes.number_of_nodes()} nodes")
    try:
        path = networkx.shortest_path(map_.nodes, (2, 0), (2, 8), weight="weight")
        print("    path over", [column for _, column in path], "- through the wall at 4:", any(picture[cell] == 0 for cell in path))
    except networkx.NetworkXNoPath:
        print("    no path")
END
venv/bin/python wall.py >seen

cat >expected <<'END'
wall of 1: 40 free cells, 45 nodes
    path over [0, 1, 2, 3, 4, 5, 6, 7, 8] - through the wall at 4: True
wall of 2: 35 free cells, 45 nodes
    no path
END
diff expected seen || { echo "CHANGED: cartoblobpy-through-the-wall" >&2; exit 1; }
echo "PASS: a path leads through a closed wall of one cell"
