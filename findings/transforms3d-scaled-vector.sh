#!/bin/sh
# SPDX-License-Identifier: MIT
# A quaternion of norm 2 rotates a vector to four times its length in one function of transforms3d and keeps it in
# another.
#
# Version:   transforms3d 0.4.2.
# Expected:  Both normalise it, or both refuse it.
# Behaviour: quat2mat normalises. rotate_vector multiplies the vector by the square of the norm, so a norm of 1.01
#            makes ranges 2 % longer.
# Hurts:     Anyone who moves points by an orientation that was rounded or averaged.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            transforms3d==0.4.2 numpy==1.26.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
import numpy as np
from transforms3d.quaternions import quat2mat, rotate_vector

for norm in (1.0, 1.01, 2.0):
    turned = [norm, 0.0, 0.0, 0.0]
    by_matrix, by_vector = quat2mat(turned) @ [5.0, 0, 0], rotate_vector([5.0, 0, 0], turned)
    print(norm, round(float(np.linalg.norm(by_matrix)), 4), round(float(np.linalg.norm(by_vector)), 4))
END

cat >expected <<'END'
1.0 5.0 5.0
1.01 5.0 5.1005
2.0 5.0 20.0
END
diff expected seen || { echo "CHANGED: transforms3d-scaled-vector" >&2; exit 1; }
echo "PASS: 5 m become 5.1 m by rotate_vector and stay 5 m by quat2mat"
