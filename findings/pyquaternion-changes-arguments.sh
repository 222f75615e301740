#!/bin/sh
# SPDX-License-Identifier: MIT
# Interpolating or rotating with pyquaternion changes the quaternions that were passed.
#
# Version:   pyquaternion 0.9.9.
# Expected:  slerp() and rotate() compute a result and leave their arguments alone.
# Behaviour: Both make the objects that they are given unit quaternions, in place.
# Hurts:     Anyone who keeps a quaternion with a norm other than 1 (an average before it is normalised, a log) and
#            looks at it again.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pyquaternion==0.9.9 numpy==1.26.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
from pyquaternion import Quaternion

total = Quaternion(2, 0, 0, 0) + Quaternion(1, 0, 0, 3)
other = Quaternion(0, 0, 0, 4)
print("before", round(total.norm, 3), round(other.norm, 3))
Quaternion.slerp(total, other, 0.5)
print("slerp", round(total.norm, 3), round(other.norm, 3))
held = Quaternion(3, 0, 0, 0)
held.rotate([1, 0, 0])
print("rotate", held.norm)
END

cat >expected <<'END'
before 4.243 4.0
slerp 1.0 1.0
rotate 1.0
END
diff expected seen || { echo "CHANGED: pyquaternion-changes-arguments" >&2; exit 1; }
echo "PASS: slerp() and rotate() leave unit quaternions behind"
