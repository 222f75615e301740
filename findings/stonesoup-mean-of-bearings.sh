#!/bin/sh
# SPDX-License-Identifier: MIT
# In Stone Soup the mean of the bearings 3.1 and -3.1 is pi by numpy.mean and 0 by the method mean() of the same object.
#
# Version:   stonesoup 1.9.1, numpy 2.4.6.
# Expected:  states.mean(axis=1) and numpy.mean(states, axis=1) are one thing, as for each array of numpy, and the mean
#            of a Bearing is circular.
# Behaviour: The function of numpy is overloaded and averages on the circle; the method is numpy's own and averages the
#            numbers: two bearings just beside the direction behind become one straight ahead. Its result is a plain
#            array, no state vector.
# Hurts:     Anyone who averages particles, sigma points or a batch of detections by the method: what is behind is
#            reported ahead.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            stonesoup==1.9.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >mean.py <<'END'
import numpy as np
from stonesoup.types.angle import Bearing
from stonesoup.types.array import StateVectors

states = StateVectors([[Bearing(3.1), Bearing(-3.1)], [1.0, 3.0]])


def show(name, mean):
    bearing, distance = np.asarray(mean).ravel()
    print(f"{name}: bearing {abs(float(bearing)):.3f}, distance {float(distance):.1f}, {type(mean).__name__}")


show("numpy.mean", np.mean(states, axis=1))
show("numpy.average", np.average(states, axis=1))
show("method mean", states.mean(axis=1))
END
venv/bin/python mean.py >seen

cat >expected <<'END'
numpy.mean: bearing 3.142, distance 2.0, StateVector
numpy.average: bearing 3.142, distance 2.0, StateVector
method mean: bearing 0.000, distance 2.0, Matrix
END
diff expected seen || { echo "CHANGED: stonesoup-mean-of-bearings" >&2; exit 1; }
echo "PASS: the mean of 3.1 and -3.1 is pi by the function and 0 by the method"
