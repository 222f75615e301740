#!/bin/sh
# SPDX-License-Identifier: MIT
# A map that an image editor has saved with an alpha channel is wall all over for cartoblobpy.
#
# Version:   cartoblobpy 0.0.10.
# Expected:  White is free and black is occupied, as in the same map without alpha; negate of a map file of ROS swaps
#            them.
# Behaviour: With an alpha channel only that counts: opaque is occupied, whatever its colour. negate and the thresholds
#            of the map file are not read, and the grey of unknown cells, 205, is free.
# Hurts:     Anyone who cleans a map of map_server in an editor, or plans on one with unknown parts.
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

cat >alpha.py <<'END'
import sys
from unittest.mock import MagicMock

import numpy
from PIL import Image

for module in ("matplotlib", "matplotlib.pyplot", "matplotlib.colors"):
    sys.modules[module] = MagicMock()  # to draw with

from cartoblobpy.graph import Graph

picture = numpy.full((10, 10), 254, numpy.uint8)
picture[:, 5:] = 205  # unknown
picture[0] = 0  # a wall
Image.fromarray(picture).save("map.pgm")
Image.fromarray(picture).convert("RGBA").save("map.png")


def free(name, *more):
    """Return how many cells of a map file are free."""
    with open("map.yaml", "w") as file:
        file.write("\n".join([f"image: {name}", "resolution: 0.05", "origin: [0, 0, 0]", "occupied_thresh: 0.65", "free_thresh: 0.196", *more]) + "\n")
    graph = Graph()
    graph.load_from_yaml("map.yaml")
    return int(graph.free_space_mask().sum())


print("cells: 45 free, 45 unknown, 10 wall")
print("map.pgm: free", free("map.pgm", "negate: 0"))
print("map.pgm, negate: free", free("map.pgm", "negate: 1"))
print("the same with alpha: free", free("map.png", "negate: 0"))
END
venv/bin/python alpha.py >seen

cat >expected <<'END'
cells: 45 free, 45 unknown, 10 wall
map.pgm: free 90
map.pgm, negate: free 90
the same with alpha: free 0
END
diff expected seen || { echo "CHANGED: cartoblobpy-alpha-is-wall" >&2; exit 1; }
echo "PASS: with an alpha channel no cell is free"
