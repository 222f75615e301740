#!/bin/sh
# SPDX-License-Identifier: MIT
# LiDARtoolkit removes a table top as ground: in each column of six centimetres all points within 20 cm of its lowest
# one go.
#
# Version:   LiDARtoolkit 0.5, pandas 3.0.6, numpy 2.4.6.
# Expected:  removeGround takes away the floor, and leaves a flat thing that is 70 cm above it.
# Behaviour: The lowest point of a column is its ground, whatever its neighbours have. Where the top hides the floor,
#            the top is the lowest. Of a wall its lowest 20 cm go, and of a box seen from above all.
# Hurts:     Anyone who looks for obstacles after it: flat and overhanging ones are gone.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            LiDARtoolkit==0.5 \
            pandas==3.0.6 \
            numpy==2.4.6 \
            python-dateutil==2.9.0.post0 \
            six==1.17.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >table.py <<'END'
from LiDARtoolkit import removeGround

floor = [[0.05 * i, 0.05 * j, 0.0] for i in range(60) for j in range(40) if not 20 <= i <= 30]
table = [[0.05 * (20 + i), 0.05 * j, 0.7] for i in range(11) for j in range(40)]
wall = [[3.0, 0.05 * j, 0.05 * k] for j in range(40) for k in range(40)]
left = removeGround(floor + table + wall).values.tolist()
for name, points in (("floor", floor), ("table top at 0.7 m", table), ("wall of 2 m", wall)):
    print(f"{name}: {len(points)} points, {sum(point in left for point in points)} left")
END
venv/bin/python table.py >seen

cat >expected <<'END'
floor: 1960 points, 0 left
table top at 0.7 m: 440 points, 40 left
wall of 2 m: 1600 points, 1440 left
END
diff expected seen || { echo "CHANGED: lidartoolkit-table-is-ground" >&2; exit 1; }
echo "PASS: no point of the table top is left"
