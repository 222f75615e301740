#!/bin/sh
# SPDX-License-Identifier: MIT
# In raycast2D the edge of a map is a wall, one cell inside of it, and yaw 0 looks up, turning clockwise.
#
# Version:   raycast2D 0.2.0, numpy 2.4.6.
# Expected:  cast() with only_true_collisions on an empty map returns no ray, and yaw 0 looks along x, as in a pose of
#            ROS.
# Behaviour: The outermost row and column count as occupied, whatever they contain, and a ray that leaves the map is a
#            true collision there. Yaw 0 is towards smaller y; 90 degrees looks along x. What stands in the outermost
#            cells themselves makes no difference.
# Hurts:     Anyone who simulates a laser on a map that was cut to a region: open sides are walls, and the filter for
#            rays without echo finds none.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            raycast2D==0.2.0 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >rays.py <<'END'
import math

import numpy as np
from raycast2D import cast

empty = np.full((50, 60), 255, np.uint8)
hits = cast(empty, (25, 25, 0.0), num_rays=360, ray_length=500, only_true_collisions=True)
print(f"an empty map of 60 x 50 cells: {len(hits)} of 360 rays hit something")
for degrees in (0, 90, 180, 270):
    hit = cast(empty, (25, 25, math.radians(degrees)), num_rays=1, FOV=0, ray_length=500)
    # a single ray is cast at the start of the field of view, which is 0 wide
    print(f"yaw {degrees}: from x 25, y 25 to", [int(v) for v in hit[0]])
near = cast(empty, (25, 25, 0.0), num_rays=360, ray_length=20, only_true_collisions=True)
print(f"with rays of 20 cells, which end inside: {len(near)}")
END
venv/bin/python rays.py >seen

cat >expected <<'END'
an empty map of 60 x 50 cells: 360 of 360 rays hit something
yaw 0: from x 25, y 25 to [25, 0]
yaw 90: from x 25, y 25 to [59, 25]
yaw 180: from x 25, y 25 to [25, 49]
yaw 270: from x 25, y 25 to [0, 25]
with rays of 20 cells, which end inside: 0
END
diff expected seen || { echo "CHANGED: raycast2d-edge-is-a-wall" >&2; exit 1; }
echo "PASS: all rays of an empty map hit its edge"
