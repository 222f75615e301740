#!/bin/sh
# SPDX-License-Identifier: MIT
# robo-utils raises NameError for each bearing from 0 to 360 degrees but the one straight ahead, and its bound of a
# full circle leaves negatives.
#
# Version:   robo-utils 0.2.7, numpy 2.4.6.
# Expected:  getAngleFromTo() with deg360=True gives the bearing between 0 and 360, and boundTo2pi() brings an angle
#            there.
# Behaviour: The function that it calls is spelled otherwise where it is defined. A target dead ahead returns before
#            the call, so a first test along x passes. boundTo2pi() keeps -90 degrees, makes -40 of -400, and keeps
#            360.
# Hurts:     Anyone who turns to a target or indexes a ring by a bearing: it works in the corridor and raises at the
#            first corner.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            robo-utils==0.2.7 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >bearings.py <<'END'
import math

import roboutils

for target in ((1, 0), (1, 1), (0, 1), (-1, 0), (0, -1)):
    plain = round(float(roboutils.getAngleFromTo(0, 0, *target)))
    try:
        full = round(float(roboutils.getAngleFromTo(0, 0, *target, deg360=True)))
    except NameError as error:
        full = f"NameError: {error}"
    print(f"to {target}: {plain}, with deg360 {full}")
for degrees in (-90, -400, 360, 370):
    print(f"boundTo2pi of {degrees} degrees:", round(math.degrees(roboutils.boundTo2pi(math.radians(degrees)))))
END
venv/bin/python bearings.py >seen

cat >expected <<'END'
to (1, 0): 0, with deg360 0
to (1, 1): 45, with deg360 NameError: name 'boundto2pi' is not defined
to (0, 1): 90, with deg360 NameError: name 'boundto2pi' is not defined
to (-1, 0): 180, with deg360 NameError: name 'boundto2pi' is not defined
to (0, -1): -90, with deg360 NameError: name 'boundto2pi' is not defined
boundTo2pi of -90 degrees: -90
boundTo2pi of -400 degrees: -40
boundTo2pi of 360 degrees: 360
boundTo2pi of 370 degrees: 10
END
diff expected seen || { echo "CHANGED: robo-utils-full-circle" >&2; exit 1; }
echo "PASS: the bearing of 0 to 360 degrees raises everywhere but ahead"
