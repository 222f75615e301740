#!/bin/sh
# SPDX-License-Identifier: MIT
# A box that stands at 30 degrees has a heading of 150 degrees in LiDARtoolkit: findBox gives the angle with the wrong
# sign, while the corners are right.
#
# Version:   LiDARtoolkit 0.5.
# Expected:  The angle is that of the longer side against the x axis: 30 degrees.
# Behaviour: The cloud is turned until the box is straight, and the angle of that turn is returned, not that of the
#            box. At 0 and at 90 degrees both are one.
# Hurts:     Anyone who follows vehicles or boxes by their heading: tests with straight ones pass.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            LiDARtoolkit==0.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >heading.py <<'END'
from math import atan2, cos, degrees, hypot, radians, sin, pi

from LiDARtoolkit import findBox


def box(heading, length=4.0, width=2.0):
    """Return points of a box of that heading in degrees."""
    turn = radians(heading)
    places = [(length * (i / 20 - 0.5), width * (j / 10 - 0.5)) for i in range(21) for j in range(11)]
    return [[x * cos(turn) - y * sin(turn), x * sin(turn) + y * cos(turn), 0.5] for x, y in places]


for heading in (0, 30, 60, 90, 120):
    corners, angle = findBox(box(heading))
    a, _, b = sorted(((*corners[0], *corner) for corner in corners[1:4]), key=lambda pair: hypot(pair[3] - pair[0], pair[4] - pair[1]))
    longer = atan2(_[4] - _[1], _[3] - _[0]) % pi
    print(f"box at {heading} degrees: angle {degrees(angle):.0f}, longer side between the corners {degrees(longer):.0f}")
END
venv/bin/python heading.py >seen

cat >expected <<'END'
box at 0 degrees: angle 0, longer side between the corners 0
box at 30 degrees: angle 150, longer side between the corners 30
box at 60 degrees: angle 120, longer side between the corners 60
box at 90 degrees: angle 90, longer side between the corners 90
box at 120 degrees: angle 60, longer side between the corners 120
END
diff expected seen || { echo "CHANGED: lidartoolkit-box-is-mirrored" >&2; exit 1; }
echo "PASS: a box at 30 degrees is said to be at 150"
