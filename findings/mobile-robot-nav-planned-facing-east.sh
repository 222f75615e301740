#!/bin/sh
# SPDX-License-Identifier: MIT
# mobile-robot-nav plans every cell as if the robot faced east: a corridor of one metre is free to the east and closed
# to the north.
#
# Version:   mobile-robot-nav 0.2, gymnasium 1.2.1, pygame-ce 2.5.6, numpy 2.2.6.
# Expected:  A robot of 1 m by 0.5 m that may turn on the spot passes a corridor of one metre in both directions.
# Behaviour: A cell is free if the robot, with its clearances, fits there at the yaw 0. Along x it needs 0.7 m, along y
#            1.15 m, and between two obstacles to the north there is no path, an empty list.
# Hurts:     Anyone who compares planners or trains in it: maps that are turned by 90 degrees have other solutions. The
#            mode modified_astar finds the way.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            mobile-robot-nav==0.2 \
            gymnasium==1.2.1 \
            pygame-ce==2.5.6 \
            numpy==2.2.6 \
            cloudpickle==3.1.1 \
            typing_extensions==4.15.0 \
            Farama-Notifications==0.0.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >corridor.py <<'END'
import os

os.environ["PYGAME_HIDE_SUPPORT_PROMPT"] = "1"

from mobile_robot_nav import MobileRobotNavEnv

EAST = [(2.0, 3.25, 0.5, 2.75), (2.0, -3.25, 0.5, 2.75)]  # centre and half of the size; the gap is from -0.5 to 0.5
NORTH = [(y, x, hy, hx) for x, y, hx, hy in EAST]


def free(env, x, y):
    return "free" if env._cell_has_valid_angle(x, y) else "closed"


for mode in ("astar", "modified_astar"):
    env = MobileRobotNavEnv(planner_mode=mode, grid_resolution=0.25, seed=1)
    for name, walls, goal in (("east", EAST, (4.0, 0.0)), ("north", NORTH, (0.0, 4.0))):
        env.obstacles = walls
        path, _ = env._astar_search((0.0, 0.0), goal)
        x, y = goal[0] / 2, goal[1] / 2
        print(f"{mode}, corridor to the {name}: {len(path)} cells, in the corridor {free(env, x, y)}")
END
venv/bin/python corridor.py >seen

cat >expected <<'END'
astar, corridor to the east: 17 cells, in the corridor free
astar, corridor to the north: 0 cells, in the corridor closed
modified_astar, corridor to the east: 17 cells, in the corridor free
modified_astar, corridor to the north: 17 cells, in the corridor free
END
diff expected seen || { echo "CHANGED: mobile-robot-nav-planned-facing-east" >&2; exit 1; }
echo "PASS: the corridor is free to the east and closed to the north"
