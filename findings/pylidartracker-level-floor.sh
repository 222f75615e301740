#!/bin/sh
# SPDX-License-Identifier: MIT
# pylidartracker cannot level a scanner that is level: for a floor that is horizontal already its transform raises
# ValueError.
#
# Version:   pylidartracker 1.0.5, scipy 1.17.1, numpy 2.4.6.
# Expected:  Where the three points of the floor are at one height, the cloud is only moved by that height.
# Behaviour: The axis of the rotation is a cross product that is zero then, and its direction is not a number. A slope
#            of a millimetre in a metre is fine.
# Hurts:     Anyone who levels a simulated scan, or a scanner that was mounted with care.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            pylidartracker==1.0.5 \
            scipy==1.17.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >level.py <<'END'
import warnings

import numpy as np
from processing.planetranformer import PlaneTransformer

warnings.simplefilter("ignore")
points = np.array([[2.0, 1.0, -1.8], [3.0, -1.0, -0.8]])  # one on the floor, one a metre above it
for name, slope in (("level", 0.0), ("a slope of 1 mm in a metre", 0.001)):
    floor = np.array([[0.0, 0.0, -1.8], [1.0, 0.0, -1.8 + slope], [0.0, 1.0, -1.8]])
    plane = PlaneTransformer()
    plane.get_plane_from_3_points(floor)
    try:
        print(f"{name}: heights {', '.join(f'{abs(z):.1f}' for z in plane.transform(points)[:, 2])}")
    except ValueError as error:
        print(f"{name}: ValueError: {error}")
END
venv/bin/python level.py >seen

cat >expected <<'END'
level: ValueError: Found zero norm quaternions in `quat`.
a slope of 1 mm in a metre: heights 0.0, 1.0
END
diff expected seen || { echo "CHANGED: pylidartracker-level-floor" >&2; exit 1; }
echo "PASS: a level floor raises, a sloping one is levelled"
