#!/bin/sh
# SPDX-License-Identifier: MIT
# In pathplan a cell that is occupied with a probability of 1 per cent is a wall, and an unknown one is free.
#
# Version:   pathplan 0.1.0, numpy 2.4.6.
# Expected:  GridMap says that it normalizes values to 0 to 1: in a map of ROS 49 of 100 becomes 0.49, and -1 is not
#            free.
# Behaviour: Nothing is scaled: each value is cut to 0 to 1. So 1 of 100 is as lethal as 100, and -1 is 0, which is
#            free. The threshold of the planner cannot help, for there is nothing between.
# Hurts:     Anyone who hands it a map of ROS: planners find no way through a clean room, or drive through what was
#            never seen.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pathplan==0.1.0 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >grid.py <<'END'
import numpy as np
from pathplan.classic.a_star import AStarPlanner
from pathplan.core.map import GridMap


def plan(cells):
    path, _ = AStarPlanner(GridMap(cells)).plan((1, 0), (1, 4))
    return "no path" if path is None else f"path of {len(path)} cells"


for name, value in (("0", 0), ("1 of 100", 1), ("49 of 100", 49), ("100", 100), ("unknown, -1", -1)):
    cells = np.zeros((3, 5), np.int8)
    cells[:, 2] = value
    grid = GridMap(cells)
    print(f"a column of {name}: cost {grid.get_cost(1, 2)}, occupied {grid.is_occupied(1, 2)}, {plan(cells)}")
END
venv/bin/python grid.py >seen

cat >expected <<'END'
a column of 0: cost 0.0, occupied False, path of 5 cells
a column of 1 of 100: cost 1.0, occupied True, no path
a column of 49 of 100: cost 1.0, occupied True, no path
a column of 100: cost 1.0, occupied True, no path
a column of unknown, -1: cost 0.0, occupied False, path of 5 cells
END
diff expected seen || { echo "CHANGED: pathplan-one-percent-is-a-wall" >&2; exit 1; }
echo "PASS: 1 of 100 is a wall and unknown is free"
