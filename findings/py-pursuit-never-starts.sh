#!/bin/sh
# SPDX-License-Identifier: MIT
# A robot that stands at the start of its path is told by py-pursuit-pathing to drive at speed 0, and so it never
# starts.
#
# Version:   py-pursuit-pathing 0.0.2, scipy 1.17.1, numpy 2.4.6.
# Expected:  curvature() gives the speed at which to drive; a robot that follows it from the start reaches the end.
# Behaviour: The speed is looked up in a trapezoidal profile by how far along the path the robot is, and the first
#            entry is 0. A robot that was pushed by 5 cm is told 0.03 and creeps off. At the end the last entries are
#            small, too.
# Hurts:     Anyone who follows a path by it from where the robot stands: no error, no motion, and the motors are
#            suspected.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            py-pursuit-pathing==0.0.2 \
            scipy==1.17.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >pursuit.py <<'END'
import contextlib
import io
import math

from py_pursuit_pathing.pose import Pose
from py_pursuit_pathing.pursuit import PurePursuitController

with contextlib.redirect_stdout(io.StringIO()):
    controller = PurePursuitController(
        [Pose(0, 0, 0), Pose(5, 0, 0), Pose(10, 3, 0)], lookahead_base=2.0, cruise_speed=2.0, acc=1.0
    )
for x in (0.0, 0.05, 1.0, 5.0):
    print(f"at {x}: speed {float(controller.curvature(Pose(x, 0, 0))[2]):.2f}")

for start in (0.0, 0.05):
    pose, seconds = Pose(start, 0, 0), 0.0
    while seconds < 30 and not controller.is_at_end(pose):
        curvature, _, speed, _ = controller.curvature(pose)
        step = float(speed) * 0.02
        heading = pose.heading + float(curvature) * step
        pose = Pose(pose.x + step * math.cos(pose.heading), pose.y + step * math.sin(pose.heading), heading)
        seconds += 0.02
    state = "at the end" if controller.is_at_end(pose) else f"at x {pose.x:.1f}, y {abs(pose.y):.1f}"
    print(f"started from {start}: {state} after {seconds:.0f} s")
END
venv/bin/python pursuit.py >seen

cat >expected <<'END'
at 0.0: speed 0.00
at 0.05: speed 0.03
at 1.0: speed 0.68
at 5.0: speed 2.00
started from 0.0: at x 0.0, y 0.0 after 30 s
started from 0.05: at the end after 12 s
END
diff expected seen || { echo "CHANGED: py-pursuit-never-starts" >&2; exit 1; }
echo "PASS: a robot at the start of its path is told to stand"
