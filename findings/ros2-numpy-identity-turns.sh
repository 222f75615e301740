#!/bin/sh
# SPDX-License-Identifier: MIT
# ros2-numpy makes a half turn of the identity: quaternions go in as x, y, z, w and are read as w, x, y, z.
#
# Version:   ros2_numpy 0.0.5, transformations 2026.1.18, ROS 2 messages 5.5.1, numpy 1.24.2.
# Expected:  numpify() of a Transform without rotation is the unit matrix, and msgify() of a matrix gives the message
#            that it was made of.
# Behaviour: The messages' order is handed to the package transformations, which has w first. No rotation becomes half
#            a turn about z, and a turn about z by 90 degrees one about an oblique axis. msgify() is right, so the
#            round trip changes each transform and pose.
# Hurts:     Anyone who moves points by /tf: a laser that is mounted straight ahead looks back.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            ros2_numpy==0.0.5 \
            transformations==2026.1.18 \
            numpy==1.24.2 \
            ros-rclpy==9.1.2 \
            ros-sensor-msgs==5.5.1 \
            ros-geometry-msgs==5.5.1 \
            ros-nav-msgs==5.5.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >transform.py <<'END'
import math

import numpy as np
import ros2_numpy
from geometry_msgs.msg import Quaternion, Transform, Vector3

for name, half in (("no turn", 0.0), ("90 degrees about z", math.pi / 4)):
    sent = Transform(
        translation=Vector3(x=1.0, y=2.0, z=0.0), rotation=Quaternion(z=math.sin(half), w=math.cos(half))
    )
    matrix = ros2_numpy.numpify(sent)
    ahead = [round(float(v), 3) + 0 for v in matrix @ np.array([1.0, 0, 0, 0])][:3]
    back = ros2_numpy.msgify(Transform, matrix).rotation
    print(f"{name}: what is ahead is at {ahead}; back as x {back.x:.2f} y {back.y:.2f} z {back.z:.2f} w {back.w:.2f}")
END
venv/bin/python transform.py >seen

cat >expected <<'END'
no turn: what is ahead is at [-1.0, 0.0, 0.0]; back as x 0.00 y 0.00 z -1.00 w 0.00
90 degrees about z: what is ahead is at [-1.0, 0.0, 0.0]; back as x 0.00 y -0.71 z -0.71 w 0.00
END
diff expected seen || { echo "CHANGED: ros2-numpy-identity-turns" >&2; exit 1; }
echo "PASS: the identity becomes half a turn"
