#!/bin/sh
# SPDX-License-Identifier: MIT
# quaternions 0.6 cannot make a quaternion of a half turn, and its angular distance of an orientation from itself is 2
# after a full turn.
#
# Version:   quaternions 0.6.
# Expected:  A rotation matrix of 180 degrees has a quaternion. The angular distance of two equal orientations is 0,
#            and of a quarter turn 1.571.
# Behaviour: The matrix is divided by a real part that is 0 for each half turn: ZeroDivisionError. distance is the
#            length of the difference of the four numbers, 0.765 for a quarter turn, and q and -q, which are one
#            orientation, are as far apart as can be.
# Hurts:     Anyone who turns a robot around, or compares two estimates of its heading.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            quaternions==0.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >turn.py <<'END'
from math import cos, pi, radians, sin

from quaternions import Quaternion

for heading in (90, 179, 180):
    c, s = round(cos(radians(heading)), 12), round(sin(radians(heading)), 12)
    try:
        q = Quaternion.from_matrix([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        print(f"matrix of {heading} degrees: w {q.w:.3f} z {q.z:.3f}")
    except ZeroDivisionError as error:
        print(f"matrix of {heading} degrees: ZeroDivisionError")
start = Quaternion.from_axis_angle([0, 0, 1], 0.5)
for name, angle in (("a quarter turn", pi / 2), ("a full turn", 2 * pi)):
    print(f"distance after {name}: {start.distance(Quaternion.from_axis_angle([0, 0, 1], 0.5 + angle)):.3f}")
END
venv/bin/python turn.py >seen

cat >expected <<'END'
matrix of 90 degrees: w 0.707 z 0.707
matrix of 179 degrees: w 0.009 z 1.000
matrix of 180 degrees: ZeroDivisionError
distance after a quarter turn: 0.765
distance after a full turn: 2.000
END
diff expected seen || { echo "CHANGED: quaternions-half-turn-raises" >&2; exit 1; }
echo "PASS: a half turn raises, and a full turn is a distance of 2"
