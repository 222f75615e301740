#!/bin/sh
# SPDX-License-Identifier: MIT
# A viewpoint with a negative number is cut or lost by mpcd: of a sensor at -0.5, 1.5, 0.2 m the origin remains.
#
# Version:   mpcd 0.1.1, pypcd4 1.5.1, numpy 2.4.6.
# Expected:  VIEWPOINT of a PCD file is read with its signs, and written again as it was.
# Behaviour: The header is read up to the first minus sign. Where it is the first number, the line is warned about and
#            the origin stands in for it; where it is a later one, the list silently ends there. The file that mpcd
#            writes has a viewpoint of one or six numbers then. pypcd4 reads all of them.
# Hurts:     Anyone who keeps the pose of the sensor in a file of scans: whatever is behind, right or below the origin
#            is lost, and the new file is not valid.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            mpcd==0.1.1 \
            pypcd4==1.5.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >viewpoint.py <<'END'
import warnings

import pypcd4
from mpcd import PointCloud

PCD = """# .PCD v0.7 - Point Cloud Data file format
VERSION 0.7
FIELDS x y z
SIZE 4 4 4
TYPE F F F
COUNT 1 1 1
WIDTH 2
HEIGHT 1
VIEWPOINT {}
POINTS 2
DATA ascii
1 2 3
4 5 6
"""

for pose in ("0.5 1.5 0.2 1 0 0 0", "-0.5 1.5 0.2 1 0 0 0", "0.5 -1.5 0.2 1 0 0 0", "0.5 1.5 0.2 0.7 0 0 -0.7"):
    with open("scan.pcd", "w") as file:
        file.write(PCD.format(pose))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        cloud = PointCloud.from_path("scan.pcd")
    cloud.save_pcd("again.pcd", "ascii")
    with open("again.pcd") as file:
        written = next(line.strip() for line in file if line.startswith("VIEWPOINT"))
    print(f"{pose}: mpcd {cloud.viewpoint}, warnings {len(caught)}, writes {written}")
    print(" " * len(pose), " pypcd4", list(pypcd4.PointCloud.from_path("scan.pcd").metadata.viewpoint))
END
venv/bin/python viewpoint.py >seen

cat >expected <<'END'
0.5 1.5 0.2 1 0 0 0: mpcd [0.5, 1.5, 0.2, 1.0, 0.0, 0.0, 0.0], warnings 0, writes VIEWPOINT 0.5 1.5 0.2 1.0 0.0 0.0 0.0
                     pypcd4 [0.5, 1.5, 0.2, 1.0, 0.0, 0.0, 0.0]
-0.5 1.5 0.2 1 0 0 0: mpcd [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], warnings 1, writes VIEWPOINT 0.0 0.0 0.0 1.0 0.0 0.0 0.0
                      pypcd4 [-0.5, 1.5, 0.2, 1.0, 0.0, 0.0, 0.0]
0.5 -1.5 0.2 1 0 0 0: mpcd [0.5], warnings 0, writes VIEWPOINT 0.5
                      pypcd4 [0.5, -1.5, 0.2, 1.0, 0.0, 0.0, 0.0]
0.5 1.5 0.2 0.7 0 0 -0.7: mpcd [0.5, 1.5, 0.2, 0.7, 0.0, 0.0], warnings 0, writes VIEWPOINT 0.5 1.5 0.2 0.7 0.0 0.0
                          pypcd4 [0.5, 1.5, 0.2, 0.7, 0.0, 0.0, -0.7]
END
diff expected seen || { echo "CHANGED: mpcd-negative-viewpoint" >&2; exit 1; }
echo "PASS: the viewpoint ends at its first minus sign"
