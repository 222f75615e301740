#!/bin/sh
# SPDX-License-Identifier: MIT
# sclerp of neura_dual_quaternions, the screw motion between two poses, is a straight line; power of the same class is
# the screw.
#
# Version:   neura_dual_quaternions 0.0.4, numpy 2.4.6.
# Expected:  Screw interpolation of a pose that is turned by 180 degrees and 2 m ahead goes along a half circle, and is
#            half way where power(0.5) is.
# Behaviour: sclerp interpolates the rotation and, apart from it, the position: the path is the straight line.
#            power(0.5) of the same motion is on the circle, 1 m aside. Twice the half way of power is the whole way;
#            twice that of sclerp is not. Between the headings 170 and -170 sclerp turns through 0 instead of 180.
# Hurts:     Anyone who interpolates grips, doors or the motion of a robot while it turns, where the way between must be
#            the one of a constant twist.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            neura_dual_quaternions==0.0.4 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >screw.py <<'END'
import numpy as np
from neura_dual_quaternions import DualQuaternion, Quaternion


def pose(x: float, degrees: float) -> DualQuaternion:
    """Return the pose at X on the x axis with a heading of DEGREES."""
    return DualQuaternion.fromQuatPos(Quaternion.fromAxisAngle(np.radians(degrees), np.array([0, 0, 1.0])), np.array([x, 0.0, 0.0]))


def place(at: DualQuaternion) -> str:
    """Return where AT is, as text."""
    x, y, _ = (float(value) for value in at.getPosition().ravel().round(2) + 0.0)
    return f"{x:.2f}, {y:.2f}"


start, end = pose(0, 0), pose(2, 179.9)
for part in (0.25, 0.5, 0.75):
    print(f"{part} of the way: sclerp at {place(DualQuaternion.sclerp(start, end, part))}, power at {place(end.power(part))}")
for name, half in (("sclerp", DualQuaternion.sclerp(start, end, 0.5)), ("power", end.power(0.5))):
    print(f"twice the half way of {name}: {place(half * half)}")
middle = DualQuaternion.sclerp(pose(0, 170), pose(0, -170), 0.5)
print(f"between 170 and -170 degrees: {np.degrees(middle.real.getAngle()):.0f}")
END
venv/bin/python screw.py >seen

cat >expected <<'END'
0.25 of the way: sclerp at 0.50, 0.00, power at 0.29, -0.71
0.5 of the way: sclerp at 1.00, 0.00, power at 1.00, -1.00
0.75 of the way: sclerp at 1.50, 0.00, power at 1.71, -0.71
twice the half way of sclerp: 1.00, 1.00
twice the half way of power: 2.00, 0.00
between 170 and -170 degrees: 0
END
diff expected seen || { echo "CHANGED: neura-screw-is-a-straight-line" >&2; exit 1; }
echo "PASS: sclerp is a straight line, power a half circle"
