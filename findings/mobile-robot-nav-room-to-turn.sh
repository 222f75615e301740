#!/bin/sh
# SPDX-License-Identifier: MIT
# The option require_rotation_clearance of mobile-robot-nav changes nothing: it tests again the angles that were found
# to be free.
#
# Version:   mobile-robot-nav 0.2, gymnasium 1.2.1, pygame-ce 2.5.6, numpy 2.2.6.
# Expected:  With the option, which is on, a cell where the robot fits at some angles and not at others is closed, since
#            it cannot turn there.
# Behaviour: The angles without a collision are collected, and then those are asked for a collision. None has one, so
#            the cell is free with the option as without.
# Hurts:     Anyone who relies on it: the path has corners in places where the robot has to turn and cannot, and it
#            stands there. Fewer angles to choose from, which exclude the narrow places, help.
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

cat >turn.py <<'END'
import os

os.environ["PYGAME_HIDE_SUPPORT_PROMPT"] = "1"
import math

from mobile_robot_nav import MobileRobotNavEnv

for option in (True, False):
    env = MobileRobotNavEnv(planner_mode="modified_astar", require_rotation_clearance=option, seed=1)
    env.obstacles = [(0.0, 1.0, 3.0, 0.6), (0.0, -1.0, 3.0, 0.6)]  # a corridor of 0.8 m along x
    fits = [angle for angle in env.planning_angle_candidates_deg if not env._collision(0.0, 0.0, math.radians(angle))]
    print(f"require_rotation_clearance={option}: fits at {fits} of {env.planning_angle_candidates_deg},", end=" ")
    print("the cell is", "free" if env._cell_has_valid_angle(0.0, 0.0) else "closed")
END
venv/bin/python turn.py >seen

cat >expected <<'END'
require_rotation_clearance=True: fits at [0] of [-90, -60, -30, 0, 30, 60, 90], the cell is free
require_rotation_clearance=False: fits at [0] of [-90, -60, -30, 0, 30, 60, 90], the cell is free
END
diff expected seen || { echo "CHANGED: mobile-robot-nav-room-to-turn" >&2; exit 1; }
echo "PASS: a cell with room for one of seven angles is free in both"
