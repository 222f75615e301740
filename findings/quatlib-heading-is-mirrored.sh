#!/bin/sh
# SPDX-License-Identifier: MIT
# A heading of 30 degrees that goes through a quaternion of quatlib comes back as -30: its matrices turn one way, and
# its quaternions the other.
#
# Version:   quatlib 0.1.0, scipy 1.17.1, numpy 2.4.6.
# Expected:  Euler angles to a matrix, to a quaternion and back give the angles that went in, and the matrix.
# Behaviour: A quaternion is made of a matrix by scipy, and read back by formulas for the inverse rotation: the matrix
#            comes back transposed and the heading with the other sign, 180 as -180. The fourth way in, axis and angle,
#            raises TypeError always.
# Hurts:     Anyone who passes orientations between parts of a robot in both forms: left and right are swapped.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            quatlib==0.1.0 \
            scipy==1.17.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >heading.py <<'END'
from math import degrees, radians

import numpy as np
import quatlib

for heading in (30, 90):
    matrix = quatlib.euler2rotMat(0.0, 0.0, radians(heading))
    quaternion = quatlib.rotMat2quatern(matrix)
    print(
        f"heading {heading}: by the matrix {degrees(quatlib.rotMat2euler(matrix)[2]):.0f}, by the quaternion {degrees(quatlib.quatern2euler(quaternion)[2]):.0f};",
        "the matrix comes back", "transposed" if np.allclose(quatlib.quatern2rotMat(quaternion), matrix.T) else "as it was",
    )
try:
    quatlib.axisAngle2quatern(np.array([0.0, 0.0, 1.0]), 1.0)
except TypeError as error:
    print("axisAngle2quatern:", type(error).__name__)
END
venv/bin/python heading.py >seen

cat >expected <<'END'
heading 30: by the matrix 30, by the quaternion -30; the matrix comes back transposed
heading 90: by the matrix 90, by the quaternion -90; the matrix comes back transposed
axisAngle2quatern: TypeError
END
diff expected seen || { echo "CHANGED: quatlib-heading-is-mirrored" >&2; exit 1; }
echo "PASS: a heading of 30 degrees comes back as -30"
