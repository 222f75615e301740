#!/bin/sh
# SPDX-License-Identifier: MIT
# The limit cycle of NeonPathPlanning raises ZeroDivisionError for an obstacle straight ahead, and goes around one
# that is behind the robot.
#
# Version:   NeonPathPlanning 1.0.1, numpy 2.4.6.
# Expected:  An obstacle in the way is passed on one side, and one that is not in the way is not looked at.
# Behaviour: The side is the sign of the distance of the obstacle from the line to the target, which is 0 / 0 where the
#            obstacle is on it. The line is taken without ends: an obstacle behind the robot or beyond the target is in
#            the way as well, and the nearer one is passed first.
# Hurts:     Anyone who plans among obstacles in round numbers, or leaves a place beside a wall.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            NeonPathPlanning==1.0.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >cycle.py <<'END'
from NeonPathPlanning.commons import Point
from NeonPathPlanning.limit_cycle import LimitCycle

ROBOT, TARGET = Point(0.0, 0.0), Point(2.0, 0.0)
for name, place in (
    ("beside the way", Point(1.0, 1.0)),
    ("in the way, 1 cm to the left", Point(1.0, 0.01)),
    ("in the way, straight ahead", Point(1.0, 0.0)),
    ("1 m behind the robot", Point(-1.0, 0.01)),
    ("3 m beyond the target", Point(5.0, 0.01)),
):
    cycle = LimitCycle()
    cycle.set_target(TARGET)
    cycle.add_obstacle(place, 0.3)
    try:
        x, y = cycle.compute(ROBOT)
        print(f"{name}: next point {x + 0:.4f}, {y + 0:.4f}")
    except ZeroDivisionError as error:
        print(f"{name}: ZeroDivisionError: {error}")
END
venv/bin/python cycle.py >seen

cat >expected <<'END'
beside the way: next point 2.0000, 0.0000
in the way, 1 cm to the left: next point 0.1275, -0.0087
in the way, straight ahead: ZeroDivisionError: float division by zero
1 m behind the robot: next point -0.1273, 0.0113
3 m beyond the target: next point 2.4911, -0.0450
END
diff expected seen || { echo "CHANGED: neonpathplanning-obstacle-straight-ahead" >&2; exit 1; }
echo "PASS: an obstacle straight ahead divides by 0"
