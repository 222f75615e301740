#!/bin/sh
# SPDX-License-Identifier: MIT
# In armkin elbow_up=True, the default, puts the elbow below the line from the shoulder to the hand.
#
# Version:   armkin 0.7.0.
# Expected:  Of the two solutions the one with elbow_up has the elbow above the line, for a target ahead.
# Behaviour: It has a positive angle at the elbow, which bends the arm upwards behind an elbow that hangs down.
#            elbow_up=False has the elbow above.
# Hurts:     Anyone who reaches over a table: the elbow goes through it. Both solutions reach the target, so no test by
#            forward() finds it.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            armkin==0.7.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >elbow.py <<'END'
import armkin

for target in ((1.0, 0.0), (1.2, 0.4), (0.5, 1.0)):
    for up in (True, False):
        shoulder, elbow = armkin.inverse(1.0, 1.0, *target, elbow_up=up)
        x, y = armkin.forward(1.0, 0.0, shoulder, 0.0)
        hand = armkin.forward(1.0, 1.0, shoulder, elbow)
        side = target[0] * y - target[1] * x  # positive above the line to the target
        print(f"target {target}, elbow_up={up}: elbow at ({x:.2f}, {y:.2f}),", "above" if side > 0 else "below", end=", ")
        print(f"hand at ({hand[0]:.2f}, {hand[1]:.2f})")
END
venv/bin/python elbow.py >seen

cat >expected <<'END'
target (1.0, 0.0), elbow_up=True: elbow at (0.50, -0.87), below, hand at (1.00, 0.00)
target (1.0, 0.0), elbow_up=False: elbow at (0.50, 0.87), above, hand at (1.00, 0.00)
target (1.2, 0.4), elbow_up=True: elbow at (0.84, -0.53), below, hand at (1.20, 0.40)
target (1.2, 0.4), elbow_up=False: elbow at (0.36, 0.93), above, hand at (1.20, 0.40)
target (0.5, 1.0), elbow_up=True: elbow at (0.99, 0.13), below, hand at (0.50, 1.00)
target (0.5, 1.0), elbow_up=False: elbow at (-0.49, 0.87), above, hand at (0.50, 1.00)
END
diff expected seen || { echo "CHANGED: armkin-elbow-up-is-down" >&2; exit 1; }
echo "PASS: elbow_up puts the elbow below"
