#!/bin/sh
# SPDX-License-Identifier: MIT
# Two vectors of py-imu are equal as soon as one of their components is: Vector3D(1, 2, 3) == Vector3D(1, 9, 9) is
# true.
#
# Version:   py-imu 0.1.0, loguru 0.7.3, numpy 2.4.6.
# Expected:  Two vectors are equal if all components are, and a comparison gives True or False.
# Behaviour: A comparison gives a vector of three truth values, and a vector is true if it is not zero: one equal
#            component is enough. != is its opposite, so these two are not unequal. < is true if one component is
#            smaller.
# Hurts:     Anyone who looks whether a sensor still delivers new samples: one axis at rest is enough for stuck.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            py-imu==0.1.0 \
            loguru==0.7.3 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >equal.py <<'END'
from py_imu.fusion.quaternion import Vector3D

a = Vector3D(1, 2, 3)
for b in (Vector3D(1, 9, 9), Vector3D(9, 9, 9), Vector3D(9, 0, 0)):
    print(f"{a} and {b}: equal {'yes' if a == b else 'no'}, unequal {'yes' if a != b else 'no'}, smaller {'yes' if a < b else 'no'}")
END
venv/bin/python equal.py >seen

cat >expected <<'END'
Vector3D(1, 2, 3) and Vector3D(1, 9, 9): equal yes, unequal no, smaller yes
Vector3D(1, 2, 3) and Vector3D(9, 9, 9): equal no, unequal yes, smaller yes
Vector3D(1, 2, 3) and Vector3D(9, 0, 0): equal no, unequal yes, smaller yes
END
diff expected seen || { echo "CHANGED: py-imu-one-equal-is-all" >&2; exit 1; }
echo "PASS: one equal component makes two vectors equal"
