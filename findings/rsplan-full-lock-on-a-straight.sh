#!/bin/sh
# SPDX-License-Identifier: MIT
# A straight path of rsplan begins with the wheels at full lock to the left and ends with full lock to the right.
#
# Version:   rsplan 1.0.10, numpy 2.4.6.
# Expected:  From 0, 0 to one metre ahead the path is one straight segment, and each waypoint has curvature 0.
# Behaviour: A curve of length 0 stands before and behind the straight. Each has waypoints of its own, at the place of
#            their neighbours, and with the curvature of the turning circle. Two of the first three waypoints are one
#            place, so the distance between them is 0.
# Hurts:     Anyone who steers by the curvature of the next waypoint, or divides by the distance to it: the robot jerks
#            where it starts and where it should stand.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            rsplan==1.0.10 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >straight.py <<'END'
from rsplan import planner

path = planner.path((0, 0, 0), (1, 0, 0), turn_radius=0.3, runway_length=0.0, step_size=0.25)
print("segments:", [(segment.type, round(float(segment.length), 3)) for segment in path.segments])
for point in path.waypoints():
    print(f"x {point.x:.2f}, y {abs(point.y):.2f}, curvature {point.curvature:.2f}")
END
venv/bin/python straight.py >seen

cat >expected <<'END'
segments: [('left', 0.0), ('straight', 1.0), ('right', 0.0)]
x 0.00, y 0.00, curvature 3.33
x 0.00, y 0.00, curvature 3.33
x 0.25, y 0.00, curvature 0.00
x 0.50, y 0.00, curvature 0.00
x 0.75, y 0.00, curvature 0.00
x 1.00, y 0.00, curvature 0.00
x 1.00, y 0.00, curvature -3.33
END
diff expected seen || { echo "CHANGED: rsplan-full-lock-on-a-straight" >&2; exit 1; }
echo "PASS: a straight path begins and ends with a curvature of 3.33"
