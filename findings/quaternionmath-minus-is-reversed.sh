#!/bin/sh
# SPDX-License-Identifier: MIT
# In quaternionmath a - b is b - a, and 1 - q is q - 1: both subtractions are reversed.
#
# Version:   quaternionmath 1.0.1.
# Expected:  A difference plus what was taken away gives what was there before.
# Behaviour: Of the two functions that Python calls for a minus each does what the other should do. Sums and products
#            are right, so a + -1 * b is a way around it.
# Hurts:     Anyone who computes an error or a derivative of an orientation: a controller drives away from its goal.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            quaternionmath==1.0.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >minus.py <<'END'
from quaternionmath import Quaternion

a, b = Quaternion(1, 2, 3, 4), Quaternion(1, 1, 1, 1)
print("a =", a, " b =", b)
print("a - b =", a - b)
print("a - b + b =", a - b + b)
print("1 - a =", 1 - a)
print("-1 * b + a =", -1 * b + a)
END
venv/bin/python minus.py >seen

cat >expected <<'END'
a = 1.0 + 2.0i + 3.0j + 4.0k  b = 1.0 + 1.0i + 1.0j + 1.0k
a - b = 0.0 + -1.0i + -2.0j + -3.0k
a - b + b = 1.0 + 0.0i + -1.0j + -2.0k
1 - a = 0.0 + 2.0i + 3.0j + 4.0k
-1 * b + a = 0.0 + 1.0i + 2.0j + 3.0k
END
diff expected seen || { echo "CHANGED: quaternionmath-minus-is-reversed" >&2; exit 1; }
echo "PASS: a - b is b - a"
