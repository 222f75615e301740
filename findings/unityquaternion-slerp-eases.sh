#!/bin/sh
# SPDX-License-Identifier: MIT
# Slerp of UnityQuaternionPy starts and ends slowly: a quarter of the way of a turn by 90 degrees is 12 degrees.
#
# Version:   UnityQuaternionPy 0.1.2.
# Expected:  A spherical interpolation goes at one rate: 22.5 degrees after a quarter, as in the library that is
#            imitated.
# Behaviour: The time is bent by a cosine, and then the numbers are interpolated in a straight line. Where one of two
#            rotations 90 degrees apart has turned signs, the way of 270 degrees is taken.
# Hurts:     Anyone who interpolates poses to the time of a scan, or computes rates from them.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            UnityQuaternionPy==0.1.2 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >slerp.py <<'END'
from UnityQuaternion import Quaternion

start, end = Quaternion.AngleAxis(0.0, (0, 1, 0)), Quaternion.AngleAxis(90.0, (0, 1, 0))
turned = Quaternion(-end.x, -end.y, -end.z, -end.w)  # the same rotation
for part in (0.1, 0.25, 0.5, 0.75):
    print(f"{part} of 90 degrees: {Quaternion.Slerp(start, end, part).eulerAngles[1]:.1f}, should be {90 * part:.1f}")
print(f"0.5, signs turned: {Quaternion.Slerp(start, turned, 0.5).eulerAngles[1]:.1f}")
END
venv/bin/python slerp.py >seen

cat >expected <<'END'
0.1 of 90 degrees: 2.0, should be 9.0
0.25 of 90 degrees: 12.4, should be 22.5
0.5 of 90 degrees: 45.0, should be 45.0
0.75 of 90 degrees: 77.6, should be 67.5
0.5, signs turned: 225.0
END
diff expected seen || { echo "CHANGED: unityquaternion-slerp-eases" >&2; exit 1; }
echo "PASS: a quarter of 90 degrees is 12 degrees"
