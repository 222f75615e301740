#!/bin/sh
# SPDX-License-Identifier: MIT
# normalized of tinyquaternion is a quaternion, but of a unit quaternion an array, which cannot rotate anything.
#
# Version:   tinyquaternion 0.0.1, numpy 2.4.6.
# Expected:  normalized is a quaternion, whatever the norm was.
# Behaviour: Within 1e-10 of 1 the bare numbers are returned. So code that normalises each pose works as long as
#            rounding errors are larger, and raises AttributeError for exact ones. The axis of a turn by 0 is NaN.
# Hurts:     Anyone who normalises before each use: a robot that stands at its start raises an error, one that has
#            moved does not.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            tinyquaternion==0.0.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >unit.py <<'END'
import warnings

import numpy as np
from tinyquaternion.tinyQuaternion import Quaternion

warnings.simplefilter("ignore")
for name, numbers in (("norm 1.0001", [1.0001, 0.0, 0.0, 0.0]), ("norm 1", [1.0, 0.0, 0.0, 0.0])):
    normalized = Quaternion(q=np.array(numbers)).normalized
    try:
        print(f"{name}: {type(normalized).__name__}, turns 1, 0, 0 to {normalized.rotatePoint(np.array([1.0, 0.0, 0.0])).tolist()}")
    except AttributeError as error:
        print(f"{name}: {type(normalized).__name__}, {error}")
print("axis and angle of no turn:", *(np.array(part).tolist() for part in Quaternion(q=np.array([1.0, 0.0, 0.0, 0.0])).axisangle()))
END
venv/bin/python unit.py >seen

cat >expected <<'END'
norm 1.0001: Quaternion, turns 1, 0, 0 to [1.0, 0.0, 0.0]
norm 1: ndarray, 'numpy.ndarray' object has no attribute 'rotatePoint'
axis and angle of no turn: [nan, nan, nan] 0.0
END
diff expected seen || { echo "CHANGED: tinyquaternion-unit-is-an-array" >&2; exit 1; }
echo "PASS: the normalised identity is an array without rotatePoint"
