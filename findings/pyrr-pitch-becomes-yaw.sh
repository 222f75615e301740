#!/bin/sh
# SPDX-License-Identifier: MIT
# From one list of Euler angles pyrr makes a quaternion that pitches and a matrix that yaws, the other way round.
#
# Version:   pyrr 0.10.3, numpy 2.4.6.
# Expected:  Matrix33.from_eulers(e) and Quaternion.from_eulers(e) are one rotation: applied to a vector they give the
#            same.
# Behaviour: The quaternion turns about x, y, z for roll, pitch, yaw; the matrix about x, z, y, and with the opposite
#            sense. Quaternion.matrix33 does not agree with the quaternion that it is made of, either: it is the
#            inverse when it is multiplied with a vector.
# Hurts:     Anyone who draws a robot by matrices and computes by quaternions: it nods where it should turn.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pyrr==0.10.3 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >euler.py <<'END'
import numpy as np
from pyrr import Matrix33, Quaternion, Vector3

POINT = Vector3([1.0, 2.0, 3.0])


def shown(vector):
    return [round(float(v), 3) for v in vector]


for name, eulers in (("roll", [0.5, 0, 0]), ("pitch", [0, 0.5, 0]), ("yaw", [0, 0, 0.5])):
    quaternion = Quaternion.from_eulers(np.array(eulers))
    print(f"{name} 0.5 of 1, 2, 3:")
    print("  quaternion       ", shown(quaternion * POINT))
    print("  its matrix33     ", shown(quaternion.matrix33 * POINT))
    print("  matrix of eulers ", shown(Matrix33.from_eulers(np.array(eulers)) * POINT))
END
venv/bin/python euler.py >seen

cat >expected <<'END'
roll 0.5 of 1, 2, 3:
  quaternion        [1.0, 0.317, 3.592]
  its matrix33      [1.0, 3.193, 1.674]
  matrix of eulers  [1.0, 3.193, 1.674]
pitch 0.5 of 1, 2, 3:
  quaternion        [2.316, 2.0, 2.153]
  its matrix33      [-0.561, 2.0, 3.112]
  matrix of eulers  [1.836, 1.276, 3.0]
yaw 0.5 of 1, 2, 3:
  quaternion        [-0.081, 2.235, 3.0]
  its matrix33      [1.836, 1.276, 3.0]
  matrix of eulers  [-0.561, 2.0, 3.112]
END
diff expected seen || { echo "CHANGED: pyrr-pitch-becomes-yaw" >&2; exit 1; }
echo "PASS: the quaternion pitches where the matrix yaws"
