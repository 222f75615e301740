#!/bin/sh
# SPDX-License-Identifier: MIT
# PSpincalc takes the last number of a quaternion for its scalar on the way to an axis and an angle: a quarter turn
# about z comes back as 270 degrees about -x.
#
# Version:   PSpincalc 0.2.7, numpy 2.4.6.
# Expected:  An axis and an angle become a quaternion, a matrix or three angles, and come back as they were, up to the
#            signs of both.
# Behaviour: EV2Q and all other functions put the scalar first. Q2EV alone takes it from the end: the axis is made of
#            the scalar, x and y, and the angle of z. The identity is half a turn about -x. EA2EV and DCM2EV go the same
#            way, so three angles do not come back through them, while they do through Q and DCM. No test of the length
#            of the axis holds: for a unit vector a text is printed that it is none.
# Hurts:     Anyone who takes the axis of a turn or the size of an error of attitude from it. Compute both from the
#            quaternion by hand.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            PSpincalc==0.2.7 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >axis.py <<'END'
import contextlib
import io

import numpy as np
import PSpincalc

for axis, degrees in (((0, 0, 1), 90), ((0, 1, 0), 30), ((0.6, 0, 0.8), 120), ((0, 0, 1), 0)):
    text = io.StringIO()
    with contextlib.redirect_stdout(text):
        turn = PSpincalc.EV2Q(np.array([*axis, np.radians(degrees)]))
        back = PSpincalc.Q2EV(turn)[0]
    said = "said to be no unit vector" if "not a unit vector" in text.getvalue() else "accepted"
    values = [float(value) for value in back[:3].round(3) + 0.0]
    print(f"{degrees} degrees about {axis}: {np.degrees(back[3]):.0f} about {values}, {said}")

angles = np.array([0.5, 0.2, -0.3])
with contextlib.redirect_stdout(io.StringIO()):
    ways = {
        "quaternion": PSpincalc.Q2EA(PSpincalc.EA2Q(angles)),
        "matrix": PSpincalc.DCM2EA(PSpincalc.EA2DCM(angles)),
        "axis and angle": PSpincalc.EV2EA(PSpincalc.EA2EV(angles)),
    }
for way, back in ways.items():
    print(f"0.5 0.2 -0.3 through {way}:", *(f"{value:.2f}" for value in back[0]))
END
venv/bin/python axis.py >seen

cat >expected <<'END'
90 degrees about (0, 0, 1): 270 about [-1.0, 0.0, 0.0], said to be no unit vector
30 degrees about (0, 1, 0): 180 about [-0.966, 0.0, -0.259], said to be no unit vector
120 degrees about (0.6, 0, 0.8): 268 about [-0.693, -0.721, 0.0], said to be no unit vector
0 degrees about (0, 0, 1): 180 about [-1.0, 0.0, 0.0], said to be no unit vector
0.5 0.2 -0.3 through quaternion: 0.50 0.20 -0.30
0.5 0.2 -0.3 through matrix: 0.50 0.20 -0.30
0.5 0.2 -0.3 through axis and angle: -0.30 -0.20 2.64
END
diff expected seen || { echo "CHANGED: psincalc-axis-is-lost" >&2; exit 1; }
echo "PASS: a quarter turn about z comes back as 270 degrees about -x"
