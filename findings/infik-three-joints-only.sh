#!/bin/sh
# SPDX-License-Identifier: MIT
# InfIK, for any number of servo motors in series, solves arms of three joints only: two raise IndexError, and four
# ValueError.
#
# Version:   InfIK 1.1, numpy 2.2.6.
# Expected:  An arm with two joints and two constraints, or four and four, is solved as one with three.
# Behaviour: The first guess has three numbers whatever the arm has: IndexError for two joints, ValueError for four.
# Hurts:     Anyone who has a leg with two joints or an arm with four. A joint of length zero and a constraint for it
#            fill up two to three.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            InfIK==1.1 \
            numpy==2.2.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >arm.py <<'END'
import math

from InfIK import Constraint, IKSystem, Joint, Solver

UP, ACROSS = (0.0, math.pi / 2), (0.0, 0.0)  # axes of joints: z and x
PLACES = [(-1, 0, 0.3), (-1, 1, 1.6), (-1, 2, 0.9), (-2, 0, -0.4)]  # joint, axis, coordinate

for count in (2, 3, 4):
    joints = [Joint(*(UP if i % 2 == 0 else ACROSS), 1.0, 0.2) for i in range(count)]
    constraints = [Constraint(count + joint, axis, value) for joint, axis, value in PLACES[:count]]
    try:
        angles, converged = Solver.solve(IKSystem(joints, constraints))
        print(f"{count} joints: converged {converged}")
    except (IndexError, ValueError) as error:
        print(f"{count} joints: {type(error).__name__}")
END
venv/bin/python arm.py >seen

cat >expected <<'END'
2 joints: IndexError
3 joints: converged True
4 joints: ValueError
END
diff expected seen || { echo "CHANGED: infik-three-joints-only" >&2; exit 1; }
echo "PASS: two joints raise IndexError and four ValueError"
