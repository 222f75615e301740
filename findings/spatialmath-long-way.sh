#!/bin/sh
# SPDX-License-Identifier: MIT
# Half way between the headings 170 and -170 degrees is 180 for SE3 and 0 for UnitQuaternion of one library.
#
# Version:   spatialmath-python 1.1.18.
# Expected:  Both give 180 degrees: 10 degrees from each.
# Behaviour: SE3.interp goes the short way. UnitQuaternion.interp goes the long way, through 0, unless shortest=True
#            is given.
# Hurts:     Anyone who smooths or resamples a heading: the robot turns round for an instant whenever it faces
#            backwards.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            spatialmath-python==1.1.18 numpy==1.26.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
from spatialmath import SE3, UnitQuaternion

for kind in (SE3, UnitQuaternion):
    ends = [kind.Rz(deg, unit="deg") for deg in (170, -170)]
    yaw = ends[0].interp(ends[1], 0.5).rpy("deg")[2]
    print(kind.__name__, abs(round(yaw)))
ends = [UnitQuaternion.Rz(deg, unit="deg") for deg in (170, -170)]
print("shortest", abs(round(ends[0].interp(ends[1], 0.5, shortest=True).rpy("deg")[2])))
END

cat >expected <<'END'
SE3 180
UnitQuaternion 0
shortest 180
END
diff expected seen || { echo "CHANGED: spatialmath-long-way" >&2; exit 1; }
echo "PASS: half way is 180 by SE3 and 0 by UnitQuaternion"
