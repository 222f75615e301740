#!/bin/sh
# SPDX-License-Identifier: MIT
# A robot 5 m outside of a map stands in its outermost cell for nav_sim2d, and is free there.
#
# Version:   nav_sim2d 0.1.3.1.2, pygame-ce 2.5.8, pygame_gui 0.6.14, pillow 13.0.0, scipy 1.17.1, numpy 2.4.6.
# Expected:  is_occupied() outside of the map is True: it has a branch for that, with a comment that says so.
# Behaviour: The cell is clipped to the map before its bounds are compared, so the branch is never taken. What stands
#            outside has the state of the nearest cell of the edge: free beside free cells, occupied beside a wall. A
#            ray meets nothing there.
# Hurts:     Anyone whose map is a part of a building: robots leave it, collide with nothing, and stand in the edge of
#            the map for planners.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            nav_sim2d==0.1.3.1.2 \
            pygame-ce==2.5.8 \
            pygame_gui==0.6.14 \
            pillow==13.0.0 \
            scipy==1.17.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >outside.py <<'END'
import os

os.environ.update(SDL_VIDEODRIVER="dummy", PYGAME_HIDE_SUPPORT_PROMPT="1")
import numpy as np
from nav_sim2d.occupancy_grid import OccupancyGridMap

floor = np.zeros((20, 20), bool)
floor[:, 19] = True
grid = OccupancyGridMap.from_grid(floor, 0.1)
print(f"map: {grid.width_m} x {grid.height_m} m, a wall along its right edge")
for x, y in ((1.0, 1.0), (-5.0, 1.0), (1.0, 50.0), (7.0, 1.0)):
    cell = [int(v) for v in grid.world_to_grid(x, y)]
    print(f"x {x}, y {y}: cell {cell}, occupied {grid.is_occupied(x, y)}")
print("ray to the left, range 4:", round(float(grid.cast_ray(1.0, 1.0, np.pi, 4.0)[0]), 2))
END
venv/bin/python outside.py >seen

cat >expected <<'END'
map: 2.0 x 2.0 m, a wall along its right edge
x 1.0, y 1.0: cell [10, 10], occupied False
x -5.0, y 1.0: cell [0, 10], occupied False
x 1.0, y 50.0: cell [10, 19], occupied False
x 7.0, y 1.0: cell [19, 10], occupied True
ray to the left, range 4: 4.0
END
diff expected seen || { echo "CHANGED: nav-sim2d-outside-is-the-edge" >&2; exit 1; }
echo "PASS: a robot 5 m outside of the map is free"
