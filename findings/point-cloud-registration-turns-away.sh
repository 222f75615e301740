#!/bin/sh
# SPDX-License-Identifier: MIT
# The ICP of point-cloud-registration turns away from the solution where the map is turned by 45, 90 or 135 degrees
# against the scan.
#
# Version:   point-cloud-registration 1.0.5, pykdtree 1.4.3, scipy 1.17.1, numpy 2.4.6.
# Expected:  From a guess that is 2 degrees off, ICP of a scan without noise converges, whatever the heading of the
#            robot.
# Behaviour: The gradient of the rotation is computed with the rotation where its inverse belongs. About 0 and 180
#            degrees in the plane the two are alike, so tests there pass. At 45 degrees the result is 13 degrees off,
#            at 90 it is 86 off, and at 135 the last step has no solution. PlaneICP of the same package is right
#            throughout.
# Hurts:     Anyone who localizes by it: it works in the hall where the robot was started, and the pose flies off in
#            the first corner.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            point-cloud-registration==1.0.5 \
            pykdtree==1.4.3 \
            scipy==1.17.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >icp.py <<'END'
import contextlib
import io

import numpy as np

with contextlib.redirect_stdout(io.StringIO()):
    from point_cloud_registration import ICP, PlaneICP


def pose(degrees):
    angle = np.radians(degrees)
    matrix = np.eye(4)
    matrix[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    matrix[:3, 3] = 0.5, 0.2, 0.0
    return matrix


def off(matrix, degrees):
    turned = np.degrees(np.arctan2(matrix[1, 0], matrix[0, 0])) - degrees
    return abs((turned + 180) % 360 - 180)


scan = np.random.default_rng(1).uniform(-2, 2, (300, 3))
for degrees in (0, 45, 90, 135, 180):
    true = pose(degrees)
    told = []
    for method in (ICP, PlaneICP):
        matcher = method(max_iter=30)
        matcher.set_target(scan @ true[:3, :3].T + true[:3, 3])
        try:
            error = off(matcher.align(scan, init_T=pose(degrees + 2)), degrees)
            told.append(f"{method.__name__} off by {'less than 0.1' if error < 0.1 else 'more than 10'} degrees")
        except np.linalg.LinAlgError:
            told.append(f"{method.__name__} raises LinAlgError")
    print(f"heading {degrees}:", ", ".join(told))
END
venv/bin/python icp.py >seen

cat >expected <<'END'
heading 0: ICP off by less than 0.1 degrees, PlaneICP off by less than 0.1 degrees
heading 45: ICP off by more than 10 degrees, PlaneICP off by less than 0.1 degrees
heading 90: ICP off by more than 10 degrees, PlaneICP off by less than 0.1 degrees
heading 135: ICP raises LinAlgError, PlaneICP off by less than 0.1 degrees
heading 180: ICP off by less than 0.1 degrees, PlaneICP off by less than 0.1 degrees
END
diff expected seen || { echo "CHANGED: point-cloud-registration-turns-away" >&2; exit 1; }
echo "PASS: ICP at a heading of 90 degrees is off by more than 10"
