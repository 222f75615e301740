#!/bin/sh
# SPDX-License-Identifier: MIT
# A pose one metre ahead equals a pose one metre behind in dual_quaternions: its == compares the translations without
# their sign.
#
# Version:   dual_quaternions 0.4.0, pyquaternion 0.9.9, numpy 2.4.6.
# Expected:  A dual quaternion and its negative are one pose, so both parts may change their sign together.
# Behaviour: Each part is compared with and without its sign on its own. With equal rotations a translation and its
#            opposite are equal, in all directions and for != as well.
# Hurts:     Anyone who tests a loop, a calibration or an inverse by it: a sign that is wrong passes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            dual_quaternions==0.4.0 \
            pyquaternion==0.9.9 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >sign.py <<'END'
from math import cos, pi, sin

from dual_quaternions import DualQuaternion

for heading in (0.0, pi / 2):
    rotation = [cos(heading / 2), 0.0, 0.0, sin(heading / 2)]
    ahead, behind, beside = (DualQuaternion.from_quat_pose_array([*rotation, *place]) for place in ((1, 0, 0), (-1, 0, 0), (0, 1, 0)))
    print(f"heading {heading:.2f}: 1 0 0 equals -1 0 0: {ahead == behind}, is unequal: {ahead != behind}; equals 0 1 0: {ahead == beside}")
END
venv/bin/python sign.py >seen

cat >expected <<'END'
heading 0.00: 1 0 0 equals -1 0 0: True, is unequal: False; equals 0 1 0: False
heading 1.57: 1 0 0 equals -1 0 0: True, is unequal: False; equals 0 1 0: False
END
diff expected seen || { echo "CHANGED: dual-quaternions-behind-is-ahead" >&2; exit 1; }
echo "PASS: a metre ahead equals a metre behind"
