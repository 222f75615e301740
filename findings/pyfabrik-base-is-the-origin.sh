#!/bin/sh
# SPDX-License-Identifier: MIT
# pyfabrik takes the origin for the base of every chain: an arm that stands at (10, 0) cannot reach what is one metre
# from it, and its first angle is that of the elbow seen from the origin.
#
# Version:   pyfabrik 0.4.0, vectormath 0.2.2, numpy 1.26.4.
# Expected:  Lengths and angles are measured from the first joint, which is given and stays where it is.
# Behaviour: A target is held against the length of the chain by its distance from the origin. The first angle is atan2
#            of the second joint's coordinates.
# Hurts:     Anyone who has two arms or an arm beside the origin: targets within reach are refused or moved to another
#            place. Subtract the base from all joints and targets.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pyfabrik==0.4.0 \
            vectormath==0.2.2 \
            numpy==1.26.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >base.py <<'END'
from pyfabrik import Fabrik2D
from vectormath import Vector2

for base in (0, 10):
    joints = [Vector2(base, 0), Vector2(base, 1), Vector2(base, 2), Vector2(base, 3)]
    arm = Fabrik2D(joints, 0.01)
    print(f"base at ({base}, 0), upright: angles", [round(float(angle), 1) for angle in arm.angles_deg[:3]])
    target = Vector2(base + 1, 1)
    print(f"  target at ({base + 1}, 1), reachable: {bool(arm.solvable(target))}", end=", ")
    moves = arm.move_to(target, try_to_reach=False)
    x, y = (round(float(value), 1) for value in arm.joints[-1])
    print("moves" if moves else "does not move", f"the hand to ({x}, {y})")
END
venv/bin/python base.py >seen

cat >expected <<'END'
base at (0, 0), upright: angles [90.0, 0.0, 0.0]
  target at (1, 1), reachable: True, moves the hand to (1.0, 1.0)
base at (10, 0), upright: angles [5.7, 84.3, 0.0]
  target at (11, 1), reachable: False, does not move the hand to (10.0, 3.0)
END
diff expected seen || { echo "CHANGED: pyfabrik-base-is-the-origin" >&2; exit 1; }
echo "PASS: an arm of 3 m does not reach 1.4 m"
