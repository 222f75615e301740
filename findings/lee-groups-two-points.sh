#!/bin/sh
# SPDX-License-Identifier: MIT
# A pose of lee_groups raises an error for three points in rows, and moves two points in rows to wrong places.
#
# Version:   lee-groups 0.1.0, numpy 2.4.6.
# Expected:  A pose times an array of points, one a row, is the moved points for each number of them, or an error for
#            each.
# Behaviour: Points are taken as columns. An array of another height raises an error, but two points in rows (three in
#            space) fit as well, and are read as their transpose: x of both as one point, y of both as another.
# Hurts:     Anyone who moves segments, the two ends of a wall, or triangles: the loop over single points and the long
#            scan are right or loud, and just those are neither.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            lee-groups==0.1.0 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >move.py <<'END'
import numpy as np
from lee import SE2

pose = SE2(np.pi / 2, np.array([1.0, 0.0]))
points = np.array([[1.0, 0.0], [2.0, 0.0], [3.0, 0.0]])


def rounded(moved):
    return (np.round(moved, 3) + 0).tolist()


print("one by one:", [rounded(pose @ point) for point in points])
for count in (3, 2):
    rows = points[:count]
    try:
        print(f"{count} in rows:", rounded(pose @ rows))
    except ValueError as error:
        print(f"{count} in rows:", type(error).__name__)
    print(f"{count} in columns, turned back to rows:", rounded((pose @ rows.T).T))
END
venv/bin/python move.py >seen

cat >expected <<'END'
one by one: [[1.0, 1.0], [1.0, 2.0], [1.0, 3.0]]
3 in rows: ValueError
3 in columns, turned back to rows: [[1.0, 1.0], [1.0, 2.0], [1.0, 3.0]]
2 in rows: [[-1.0, 1.0], [1.0, 0.0]]
2 in columns, turned back to rows: [[1.0, 1.0], [1.0, 2.0]]
END
diff expected seen || { echo "CHANGED: lee-groups-two-points" >&2; exit 1; }
echo "PASS: two points in rows are moved as their transpose"
