#!/bin/sh
# SPDX-License-Identifier: MIT
# A scan that pointcloudkit converts to LAS is rounded to centimetres, and its intensities between 0 and 1 are all 0.
#
# Version:   pointcloudkit 0.1.0, laspy 2.7.0, numpy 2.4.6.
# Expected:  convert() from PCD to LAS keeps millimetres, and an intensity of 0.99 remains distinct from one of 0.01.
# Behaviour: The scale of the LAS file is the one that laspy begins with, 0.01 in each axis, whatever the points are.
#            Intensities are cut to whole numbers, so those of a scanner that reports 0 to 1 vanish. Nothing is said
#            about either.
# Hurts:     Anyone who passes scans of a room to tools of surveyors: 4 mm is 0, and reflectors cannot be told from
#            walls.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pointcloudkit==0.1.0 \
            laspy==2.7.0 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >convert.py <<'END'
import laspy
import numpy as np
from pointcloudkit import PointCloud, convert

scan = PointCloud(
    position=np.array([[1.2345, 0.004, 0.0], [1.2385, 0.006, 0.0]]),
    intensity=np.array([0.01, 0.99], np.float32),
)
scan.write("scan.pcd")
convert("scan.pcd", "scan.las")
print("scales of the LAS file:", [float(s) for s in laspy.read("scan.las").header.scales])
for name in ("scan.pcd", "scan.las"):
    cloud = PointCloud.read(name)
    positions = [[round(float(v), 4) for v in row] for row in cloud.position]
    print(f"{name}: {positions}, intensities {[round(float(v), 2) for v in cloud.intensity]}")
END
venv/bin/python convert.py >seen

cat >expected <<'END'
scales of the LAS file: [0.01, 0.01, 0.01]
scan.pcd: [[1.2345, 0.004, 0.0], [1.2385, 0.006, 0.0]], intensities [0.01, 0.99]
scan.las: [[1.23, 0.0, 0.0], [1.24, 0.01, 0.0]], intensities [0.0, 0.0]
END
diff expected seen || { echo "CHANGED: pointcloudkit-las-centimetres" >&2; exit 1; }
echo "PASS: 1.2345 m is 1.23 m in the LAS file"
