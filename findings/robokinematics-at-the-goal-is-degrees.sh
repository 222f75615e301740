#!/bin/sh
# SPDX-License-Identifier: MIT
# RoboKinematics tells a robot that is at its goal already to go to a 57th of its angles, and leaves the model at zero
# after each solution.
#
# Version:   RoboKinematics 1.0.2, scipy 1.17.1, matplotlib 3.10.3, numpy 2.2.6.
# Expected:  The inverse of a pose is the angles that have this pose, in radians, and the model is there or where it
#            was.
# Behaviour: A start at the goal needs no iteration, and then the angles in radians are converted from degrees to
#            radians once more. For a goal out of reach all angles are 0, which is a pose like any other; only the
#            attribute success tells.
# Hurts:     Anyone who sends the result to a robot: one that should stand still stretches out. Call f_kin() with other
#            angles before, ask success, and f_kin() with the result after it.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            RoboKinematics==1.0.2 \
            scipy==1.17.1 \
            matplotlib==3.10.3 \
            numpy==2.2.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >goal.py <<'END'
import contextlib
import io
import os

os.environ["MPLBACKEND"] = "Agg"

import numpy as np
from RoboKinematics import CreateKinematicModel

JOINT = {"frame_name": "a", "joint_type": "r", "link_length": 1.0, "twist": 0.0, "offset": 0.0, "theta": 0.0}
robot = CreateKinematicModel([dict(JOINT) for _ in range(3)], "arm")
ANGLES = [0.3, 0.5, 0.2]
robot.f_kin(ANGLES, rads=True)
goal = robot.SE3(robot.get_transforms(3), merge_res=True)
for name, start, target in (
    ("from elsewhere", [0.1, 0.1, 0.1], goal),
    ("from the goal", ANGLES, goal),
    ("out of reach", [0.1, 0.1, 0.1], np.array([9.0, 0.0, 0.0, 0.0, 0.0, 0.0])),
):
    robot.f_kin(start, rads=True)
    with contextlib.redirect_stdout(io.StringIO()):
        angles = robot.i_kin(target)
    print(f"{name}: success {robot.success}, angles {[round(float(value), 3) for value in angles]}", end=", ")
    print("hand of the model then at", [round(float(value), 2) for value in robot.get_tcp()])
END
venv/bin/python goal.py >seen

cat >expected <<'END'
from elsewhere: success True, angles [0.3, 0.5, 0.2], hand of the model then at [3.0, 0.0, 0.0]
from the goal: success True, angles [0.005, 0.009, 0.003], hand of the model then at [3.0, 0.0, 0.0]
out of reach: success False, angles [0.0, 0.0, 0.0], hand of the model then at [3.0, 0.0, 0.0]
END
diff expected seen || { echo "CHANGED: robokinematics-at-the-goal-is-degrees" >&2; exit 1; }
echo "PASS: 0.3, 0.5, 0.2 come back as 0.005, 0.009, 0.003"
