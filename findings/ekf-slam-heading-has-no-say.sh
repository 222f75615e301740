#!/bin/sh
# SPDX-License-Identifier: MIT
# The heading of ekf_slam has no influence: a robot that faces north and drives one metre ahead goes east.
#
# Version:   ekf_slam 0.0.2.
# Expected:  A movement of (1 m, 0 rad) goes along the heading, and a landmark at (2 m, 0 rad) is straight ahead.
# Behaviour: Both angles are counted from the x axis of the map. Yet the angle of a movement is added to the heading as
#            if it were a turn, which so becomes the sum of all directions driven: after a square of four sides it is 3
#            pi more.
# Hurts:     Anyone who gives it odometry and bearings of a robot: the map is right as long as the robot does not turn.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            ekf_slam==0.0.2 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >north.py <<'END'
import numpy as np

from ekf_slam import KnownCorrespondence

small = np.eye(3) * 1e-6
for heading in (0.0, np.pi / 2):
    slam = KnownCorrespondence(np.array([0.0, 0.0, heading]), 1, np.eye(2) * 1e-6, small)
    slam.predict(np.array([1.0, 0.0]))
    robot = slam.robot_pos() + 0.0
    slam.update(np.array([[2.0, 0.0, 0]]))
    print(f"heading {np.degrees(heading):.0f}: 1 m ahead is at {robot.round(2) + 0}, a landmark 2 m ahead at {slam.landmark_pos(0).round(2) + 0}")
slam = KnownCorrespondence(np.zeros(3), 1, np.eye(2) * 1e-6, small)
for direction in (0, 90, 180, 270):
    slam.predict(np.array([1.0, np.radians(direction)]))
    print(f"1 m towards {direction}: at {slam.robot_pos().round(2) + 0}, heading {np.degrees(slam.mean[2]):.0f}")
END
venv/bin/python north.py >seen

cat >expected <<'END'
heading 0: 1 m ahead is at [1. 0.], a landmark 2 m ahead at [3. 0.]
heading 90: 1 m ahead is at [1. 0.], a landmark 2 m ahead at [3. 0.]
1 m towards 0: at [1. 0.], heading 0
1 m towards 90: at [1. 1.], heading 90
1 m towards 180: at [0. 1.], heading 270
1 m towards 270: at [0. 0.], heading 540
END
diff expected seen || { echo "CHANGED: ekf-slam-heading-has-no-say" >&2; exit 1; }
echo "PASS: one metre ahead of a robot that faces north is one metre east"
