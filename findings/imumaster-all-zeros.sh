#!/bin/sh
# SPDX-License-Identifier: MIT
# Quaternion(1, 0, 0, 0) of imumaster is 0, 0, 0, 0: the first of four numbers is taken for the flag that says where the
# scalar is.
#
# Version:   imumaster 0.0.2, numpy 2.2.6.
# Expected:  Four individual numbers are the four components, as the documentation has it, and scalar_first has a
#            default.
# Behaviour: The flag is the first positional argument. Of four numbers three remain, which are neither one list nor
#            four, and all components stay 0 without an error. The inverse of a quaternion with its scalar last has its
#            x and z exchanged.
# Hurts:     Anyone who makes a quaternion by hand: rotations by it are NaN or nothing. Quaternion(True, 1, 0, 0, 0)
#            works.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            imumaster==0.0.2 \
            numpy==2.2.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >quaternion.py <<'END'
import numpy as np
from imumaster.math import Quaternion


def plain(values):
    return (np.round(values, 3) + 0.0).tolist()


print("Quaternion(1, 0, 0, 0):", plain(Quaternion(1, 0, 0, 0).value))
print("Quaternion(0.5, 0.5, 0.5, 0.5):", plain(Quaternion(0.5, 0.5, 0.5, 0.5).value))
print("Quaternion([1, 0, 0, 0]):", plain(Quaternion([1, 0, 0, 0]).value))
print("Quaternion(True, 1, 0, 0, 0):", plain(Quaternion(True, 1, 0, 0, 0).value))
last = Quaternion(False, 0.1, 0.2, 0.3, 0.9)
print("x, y, z, w:", plain(last.value), "inverse:", plain(last.inv), "by inverse():", plain(Quaternion.inverse(last.value, False)))
END
venv/bin/python quaternion.py >seen

cat >expected <<'END'
Quaternion(1, 0, 0, 0): [0.0, 0.0, 0.0, 0.0]
Quaternion(0.5, 0.5, 0.5, 0.5): [0.0, 0.0, 0.0, 0.0]
Quaternion([1, 0, 0, 0]): [0.0, 0.0, 0.0, 0.0]
Quaternion(True, 1, 0, 0, 0): [1.0, 0.0, 0.0, 0.0]
x, y, z, w: [0.1, 0.2, 0.3, 0.9] inverse: [-0.316, -0.211, -0.105, 0.947] by inverse(): [-0.105, -0.211, -0.316, 0.947]
END
diff expected seen || { echo "CHANGED: imumaster-all-zeros" >&2; exit 1; }
echo "PASS: four numbers make a quaternion of zeros"
