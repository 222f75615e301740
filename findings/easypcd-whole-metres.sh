#!/bin/sh
# SPDX-License-Identifier: MIT
# easypcd writes text clouds in whole numbers: 0.9 m is 0, and coloured PCD files that neither it nor pypcd4 can read.
#
# Version:   easypcd 0.0.33, pypcd4 1.5.1, scipy 1.17.1, numpy 2.4.6.
# Expected:  write_txt() writes the coordinates; write_pcd() with color=True writes a file that read_pcd() reads.
# Behaviour: write_txt() cuts each number to its whole part. With color=True the header declares x, y, z and rgb, and
#            the rows still hold red, green and blue on their own: six numbers where four are declared. Both readers
#            raise an error.
# Hurts:     Anyone who hands scans in metres to a spreadsheet, or colours them by range: walls become staircases of a
#            metre, and the colours cost the cloud.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            easypcd==0.0.33 \
            pypcd4==1.5.1 \
            scipy==1.17.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >clouds.py <<'END'
import numpy as np
import pypcd4
from easypcd import ep

points = np.array([[0.9, 1.7, -0.6], [2.5, 0.4, 0.2]])
ep.write_txt("scan.txt", points)
with open("scan.txt") as file:
    print("text:", file.read().split())

ep.write_pcd("scan.pcd", np.hstack([points, [[255, 0, 0], [0, 255, 0]]]), color=True)
with open("scan.pcd") as file:
    lines = file.read().splitlines()
print("header:", lines[2], "| numbers in a row:", len(lines[11].split()))
for name, read in (("easypcd", ep.read_pcd), ("pypcd4", pypcd4.PointCloud.from_path)):
    try:
        read("scan.pcd")
        print(name, "reads it")
    except Exception as error:
        print(name, "raises", type(error).__name__)
END
venv/bin/python clouds.py >seen

cat >expected <<'END'
text: ['0', '1', '0', '2', '0', '0']
header: FIELDS x y z rgb | numbers in a row: 6
easypcd raises ValueError
pypcd4 raises ValueError
END
diff expected seen || { echo "CHANGED: easypcd-whole-metres" >&2; exit 1; }
echo "PASS: 0.9 m is written as 0"
