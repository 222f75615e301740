#!/bin/sh
# SPDX-License-Identifier: MIT
# A quintic trajectory of RoboKinematics that starts with an acceleration misses its goal: from 0 to 1 rad in 2 s,
# starting with 1 rad/s2, it ends at 3 rad.
#
# Version:   RoboKinematics 1.0.2, scipy 1.17.1, matplotlib 3.10.3, numpy 2.2.6.
# Expected:  A polynomial of the fifth degree has both positions, both speeds and both accelerations as given.
# Behaviour: In three coefficients the first and the last acceleration are exchanged. With both at 0, the default, or
#            both equal, the end is right; otherwise it is off by half of their difference times the square of the time.
# Hurts:     Anyone who joins pieces without a jerk: each piece ends elsewhere, and the next one starts with a jump.
#            Give both ends the same acceleration.
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

cat >quintic.py <<'END'
import os

os.environ["MPLBACKEND"] = "Agg"

from RoboKinematics import CreateKinematicModel

JOINT = {"frame_name": "a", "joint_type": "r", "link_length": 1.0, "twist": 0.0, "offset": 0.0, "theta": 0.0}
for first, last in ((0, 0), (1, 0), (0, 1), (1, 1)):
    robot = CreateKinematicModel([dict(JOINT)], "arm")
    robot.f_kin([0.0])
    robot.accel(first, last)
    position, speed, acceleration = (robot.traj_gen([[0.0], [1.0]], what, "q", [2])[0][0] for what in range(3))
    print(f"accelerations {first} and {last}: from {position[0]:.2f} to {position[-1]:.2f},", end=" ")
    print(f"last speed {speed[-1]:.2f}, last acceleration {acceleration[-1]:.2f}")
END
venv/bin/python quintic.py >seen

cat >expected <<'END'
accelerations 0 and 0: from 0.00 to 1.00, last speed 0.00, last acceleration 0.00
accelerations 1 and 0: from 0.00 to 3.00, last speed 2.00, last acceleration 2.00
accelerations 0 and 1: from 0.00 to -1.00, last speed -2.00, last acceleration -1.00
accelerations 1 and 1: from 0.00 to 1.00, last speed 0.00, last acceleration 1.00
END
diff expected seen || { echo "CHANGED: robokinematics-misses-its-goal" >&2; exit 1; }
echo "PASS: the trajectory to 1 ends at 3"
