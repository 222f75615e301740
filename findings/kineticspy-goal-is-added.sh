#!/bin/sh
# SPDX-License-Identifier: MIT
# A trajectory of kineticspy ends at the sum of its start and its goal, and an arm that follows a line across the y
# axis stretches upwards on the way.
#
# Version:   kineticspy 0.0.1, numpy 2.4.6.
# Expected:  calctrac from 30 to 90 degrees ends at 90, and each point of a line has its own angles.
# Behaviour: The goal is multiplied by the time and added to the start: 30 to 90 ends at 120, and a start that is the
#            goal already ends at twice of it. For a point with x = 0 the inverse is the number 0, which numpy stores
#            as 0 for all joints.
# Hurts:     Anyone who moves an arm with a sensor by these angles: in the middle of a line it strikes out.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            kineticspy==0.0.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >arm.py <<'END'
import math
import sys
from unittest.mock import MagicMock

for module in ("plotly", "plotly.graph_objs"):
    sys.modules[module] = MagicMock()  # for pictures

import numpy as np
from kineticspy import trajectory as traj
from kineticspy.robobj.robot import Robot

Z, Y = [0, 0, 1], [0, 1, 0]
arm = Robot(3, [Z, Y, Y], [[0, 0, 1.0], [0, 0, 1.0], [0, 0, 1.0]])
for start, goal in ((0, 90), (30, 90), (90, 90)):
    ends = traj.calctrac(arm, [math.radians(start), math.pi / 2, 0.0], [math.radians(goal), 0.0, 0.0], 9)
    x, y, _ = ends[-1][3]
    print(f"turn from {start} to {goal}: ends at {math.degrees(math.atan2(y, x)):.0f}")
line = traj.viapts(arm, [[-0.9, 1.0, 1.0], [0.0, 1.0, 1.0], [0.9, 1.0, 1.0]])
for number in (7, 8, 9, 10, 11):
    print(f"point {number} of the line at y 1, z 1:", *(f"{value + 0:.1f}" for value in np.round(line[number][3], 1)))
END
venv/bin/python arm.py >seen

cat >expected <<'END'
turn from 0 to 90: ends at 90
turn from 30 to 90: ends at 120
turn from 90 to 90: ends at 180
point 7 of the line at y 1, z 1: -0.2 1.0 1.0
point 8 of the line at y 1, z 1: -0.1 1.0 1.0
point 9 of the line at y 1, z 1: 0.0 0.0 3.0
point 10 of the line at y 1, z 1: 0.0 0.0 3.0
point 11 of the line at y 1, z 1: 0.1 1.0 1.0
END
diff expected seen || { echo "CHANGED: kineticspy-goal-is-added" >&2; exit 1; }
echo "PASS: 30 to 90 degrees ends at 120"
