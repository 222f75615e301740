#!/bin/sh
# SPDX-License-Identifier: MIT
# In kalmanfilterByRuhail the extended filter and the helper that makes filters raise NameError on every call.
#
# Version:   kalmanfilterByRuhail 0.1.1, matplotlib 3.10.3, numpy 2.2.6.
# Expected:  Each of the four names of the package works, as the plain filter does.
# Behaviour: The modules of the extended filter and of the helper use numpy and do not import it. Making an extended
#            filter works, its first prediction and its first measurement raise.
# Hurts:     Anyone who needs the extended filter, which is what the package adds. Setting np in the two modules from
#            outside helps: import them, and assign.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            kalmanfilterByRuhail==0.1.1 \
            matplotlib==3.10.3 \
            numpy==2.2.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >helper.py <<'END'
import os

os.environ["MPLBACKEND"] = "Agg"

import numpy as np
from kalmanfilterByRuhail import ExtendedKalmanFilter, KalmanFilter, initialize_kalman

one, zero = np.eye(1), np.zeros(1)


def slope(x):
    return one


def same(x):
    return x


for name, made in (
    ("KalmanFilter", lambda: KalmanFilter(one, one, one, one, one, zero)),
    ("ExtendedKalmanFilter", lambda: ExtendedKalmanFilter(one, one, one, one, one, zero, same, same, slope, slope)),
    ("initialize_kalman", lambda: initialize_kalman(1, 0.1, 0.1)),
):
    for step, arguments in (("predict", ()), ("update", (np.array([1.0]),))):
        try:
            getattr(made(), step)(*arguments)
            print(f"{name}, {step}: works")
        except NameError as error:
            print(f"{name}, {step}: NameError: {error}")
END
venv/bin/python helper.py >seen

cat >expected <<'END'
KalmanFilter, predict: works
KalmanFilter, update: works
ExtendedKalmanFilter, predict: NameError: name 'np' is not defined
ExtendedKalmanFilter, update: NameError: name 'np' is not defined
initialize_kalman, predict: NameError: name 'np' is not defined
initialize_kalman, update: NameError: name 'np' is not defined
END
diff expected seen || { echo "CHANGED: kalmanfilterbyruhail-helper-raises" >&2; exit 1; }
echo "PASS: two of three raise NameError"
