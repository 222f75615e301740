#!/bin/sh
# SPDX-License-Identifier: MIT
# Kalman 0.1.3 takes the slopes of a motion at the state after the step, and writes into the vector it was given.
#
# Version:   Kalman 0.1.3, numpy 2.4.6.
# Expected:  An extended Kalman filter takes the Jacobian at the state before the step, and keeps its arguments.
# Behaviour: predict moves the means first. A robot that is unsure of its heading, drives 1 m along x and turns by 90
#            degrees at its end is unsure along x afterwards, not across. update adds to the array that was passed as
#            the first state.
# Hurts:     Anyone who drives curves, or starts several filters from one state.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            Kalman==0.1.3 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >slopes.py <<'END'
import numpy as np

from Kalman import ExtendedKalmanFilter


def move(state, order):
    """Drive by order[0] along the heading, then turn by order[1]."""
    x, y, heading = state
    return np.array([x + order[0] * np.cos(heading), y + order[0] * np.sin(heading), heading + order[1]])


def slopes(state, order):
    """Return the Jacobian of move by the state."""
    return np.array([[1, 0, -order[0] * np.sin(state[2])], [0, 1, order[0] * np.cos(state[2])], [0, 0, 1]])


still = lambda *_: np.zeros((3, 3))
place = np.array([[1.0, 0, 0], [0, 1, 0]])
first = np.zeros(3)
for turn in (0.0, np.pi / 2):
    robot = ExtendedKalmanFilter(first, np.diag([0, 0, 0.01]), move, slopes, still, lambda state: state[:2], lambda state: place, lambda _: np.eye(2) * 1e-6)
    robot.predict((1.0, turn))
    print(f"1 m along x, then {np.degrees(turn):.0f} degrees: unsure by {robot.standard_deviations().round(3)[:2]} m along x and y")
robot = ExtendedKalmanFilter(first, np.eye(3), move, slopes, still, lambda state: state[:2], lambda state: place, lambda _: np.eye(2))
robot.update(np.array([2.0, 0.0]))
print("the first state, after an update with (2, 0):", first)
END
venv/bin/python slopes.py >seen

cat >expected <<'END'
1 m along x, then 0 degrees: unsure by [0.  0.1] m along x and y
1 m along x, then 90 degrees: unsure by [0.1 0. ] m along x and y
the first state, after an update with (2, 0): [1. 0. 0.]
END
diff expected seen || { echo "CHANGED: kalman-slopes-after-the-step" >&2; exit 1; }
echo "PASS: a robot that drove along x is unsure along x"
