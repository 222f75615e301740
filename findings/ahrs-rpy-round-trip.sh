#!/bin/sh
# SPDX-License-Identifier: MIT
# In AHRS a roll of 0.5 rad given to DCM comes back as a yaw of -0.5; Quaternion takes the same list the other way
# round.
#
# Version:   AHRS 0.4.0, numpy 2.4.6.
# Expected:  DCM(rpy=a).to_rpy() is a, and DCM(rpy=a) and Quaternion(rpy=a) are one rotation.
# Behaviour: The constructor of DCM reads yaw, pitch, roll; its to_rpy() returns roll, pitch, yaw, of the opposite
#            rotation. Quaternion reads and returns roll, pitch, yaw. A pure pitch comes back with its sign changed.
# Hurts:     Anyone who keeps the attitude of a robot or the mounting of a sensor as roll, pitch and yaw, and changes
#            between the two classes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            AHRS==0.4.0 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >attitude.py <<'END'
import numpy as np
from ahrs import DCM, Quaternion

for name, rpy in (("roll", [0.5, 0.0, 0.0]), ("pitch", [0.0, 0.5, 0.0]), ("yaw", [0.0, 0.0, 0.5])):
    matrix = DCM(rpy=rpy)
    quaternion = Quaternion(rpy=rpy)
    apart = float(np.abs(np.array(matrix) - np.array(quaternion.to_DCM())).max())
    print(
        f"{name} 0.5: DCM returns {[round(float(a) + 0, 3) + 0 for a in matrix.to_rpy()]},",
        f"Quaternion {[round(float(a), 3) for a in quaternion.to_angles()]}, matrices differ by {apart:.2f}",
    )
END
venv/bin/python attitude.py >seen

cat >expected <<'END'
roll 0.5: DCM returns [0.0, 0.0, -0.5], Quaternion [0.5, 0.0, 0.0], matrices differ by 0.48
pitch 0.5: DCM returns [0.0, -0.5, 0.0], Quaternion [0.0, 0.5, 0.0], matrices differ by 0.00
yaw 0.5: DCM returns [-0.5, 0.0, 0.0], Quaternion [0.0, 0.0, 0.5], matrices differ by 0.48
END
diff expected seen || { echo "CHANGED: ahrs-rpy-round-trip" >&2; exit 1; }
echo "PASS: a roll of 0.5 comes back as a yaw of -0.5"
