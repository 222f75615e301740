#!/bin/sh
# SPDX-License-Identifier: MIT
# stateEstimation adds the next state to the last one: a speed that decays to 0.37 in a second is predicted to grow to
# 1.37, and a robot with position and speed raises LinAlgError.
#
# Version:   stateEstimation 0.1, scipy 1.10.1, numpy 1.23.5.
# Expected:  With discretize=True the model of continuous time becomes one of steps, and a prediction is one step of it.
# Behaviour: The model of steps is used as if it were the rate of change: the old state stays, and the new one is added
#            to it. The input matrix needs the inverse of A, which a position that depends on a speed has not got.
# Hurts:     Anyone who filters odometry with it: without measurements the state grows, and with them it lags.
#            discretize=False with A of the continuous model steps by Euler's rule.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            stateEstimation==0.1 \
            scipy==1.10.1 \
            numpy==1.23.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >decay.py <<'END'
import warnings

warnings.simplefilter("ignore")
import math

import numpy as np
from stateEstimation import KF

ONE = np.eye(1)
for discretize in (True, False):
    speed = KF(-ONE, ONE, ONE, ONE, ONE, T=1.0 if discretize else 0.01, discretize=discretize)
    speed.x = np.array([[1.0]])
    for _ in range(1 if discretize else 100):
        speed.predict()
    print(f"discretize={discretize}: after 1 s {speed.x[0, 0]:.3f}")
print(f"by the equation: {math.exp(-1):.3f}")
try:
    KF(np.array([[0.0, 1.0], [0.0, 0.0]]), np.array([[0.0], [1.0]]), ONE, ONE, ONE)
except np.linalg.LinAlgError as error:
    print("position and speed: LinAlgError:", error)
END
venv/bin/python decay.py >seen

cat >expected <<'END'
discretize=True: after 1 s 1.368
discretize=False: after 1 s 0.366
by the equation: 0.368
position and speed: LinAlgError: Singular matrix
END
diff expected seen || { echo "CHANGED: stateestimation-predicts-twice" >&2; exit 1; }
echo "PASS: 1 is predicted as 1.368, not as 0.368"
