#!/bin/sh
# SPDX-License-Identifier: MIT
# In AuroraMR forward(-1) drives back, turn_left(-90 degrees) turns left, and a car told to turn by 360 degrees stands
# still.
#
# Version:   AuroraMR 0.3.3, numpy 2.4.6.
# Expected:  A negative distance and a negative angle both mean the other direction, and a full circle is driven by
#            each kind of robot.
# Behaviour: forward() keeps the sign of the distance; forward_wheels() and turn_left() drop theirs. An Ackermann robot
#            turns until its heading is right modulo a full circle: 360 degrees are reached before it moves, 400 after
#            40.
# Hurts:     Anyone who feeds commands with signs, as recorded or computed ones have: the path looks plausible and goes
#            elsewhere.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            AuroraMR==0.3.3 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >turns.py <<'END'
import math

import AuroraMR as amr

Kind = amr.KinematicsModel
MODELS = {
    Kind.DIFFERENTIAL: {"differential": amr.DifferentialParams(track_width=0.4, max_wheel_speed=2.0)},
    Kind.ACKERMANN: {
        "ackermann": amr.AckermannParams(wheelbase=0.55, track_width=0.36, max_steering_angle=0.48, max_speed=1.0)
    },
}


def run(kind, name, *command):
    session = amr.MotionSession.create(amr.pose(0, 0, 0), kind, dt=0.02, **MODELS[kind])
    getattr(session, name)(*command)
    pose = session.pose
    shown = [round(value, 1) + 0.0 for value in (pose.x, pose.y, math.degrees(pose.theta))]
    return f"x {shown[0]}, y {shown[1]}, heading {round(shown[2])}, {len(session.poses) - 1} steps"


print("forward -1 m:", run(Kind.DIFFERENTIAL, "forward", -1.0, 0.5))
print("forward_wheels -1 m:", run(Kind.DIFFERENTIAL, "forward_wheels", -1.0, 0.5))
for kind in MODELS:
    for angle in (90, -90, 360, 400):
        print(f"{kind.name} turn_left {angle}:", run(kind, "turn_left", math.radians(angle), 0.5))
END
venv/bin/python turns.py >seen

cat >expected <<'END'
forward -1 m: x 0.0, y -1.0, heading 0, 100 steps
forward_wheels -1 m: x 0.0, y 1.0, heading 0, 100 steps
DIFFERENTIAL turn_left 90: x 0.0, y 0.0, heading 90, 158 steps
DIFFERENTIAL turn_left -90: x 0.0, y 0.0, heading 90, 158 steps
DIFFERENTIAL turn_left 360: x 0.0, y 0.0, heading 0, 629 steps
DIFFERENTIAL turn_left 400: x 0.0, y 0.0, heading 40, 699 steps
ACKERMANN turn_left 90: x -1.0, y 1.1, heading 89, 547 steps
ACKERMANN turn_left -90: x -1.0, y 1.1, heading 89, 547 steps
ACKERMANN turn_left 360: x 0.0, y 0.0, heading 0, 0 steps
ACKERMANN turn_left 400: x -0.2, y 0.7, heading 39, 239 steps
END
diff expected seen || { echo "CHANGED: auroramr-turns-one-way" >&2; exit 1; }
echo "PASS: a turn by -90 degrees to the left is one to the left"
