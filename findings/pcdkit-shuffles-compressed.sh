#!/bin/sh
# SPDX-License-Identifier: MIT
# A compressed PCD file of pcdkit comes back with its coordinates shuffled, in pcdkit itself as elsewhere.
#
# Version:   pcdkit 0.2.14, pypcd4 1.5.1, numpy 2.4.6.
# Expected:  save() with binary_compressed and load_pcd_from_path() are inverse to each other, and other readers agree.
# Behaviour: The format keeps all x first, then all y and so on. pcdkit reads it that way and writes it point after
#            point, so x of the second point is the y or the intensity of the first one. A file of pypcd4 is read
#            rightly. Uncompressed files are right, too.
# Hurts:     Anyone who saves space: numbers, header and size look right, and the scan is a cloud of noise.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pcdkit==0.2.14 \
            pypcd4==1.5.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >compressed.py <<'END'
import numpy as np
import pcdkit
import pypcd4

NAMES = ("x", "y", "z", "intensity")
points = np.array(
    [(1, 2, 3, 10), (4, 5, 6, 20), (7, 8, 9, 30)], dtype=[(name, np.float32) for name in NAMES]
)


def show(what, rows):
    print(f"{what}:", [tuple(float(v) for v in row) for row in rows])


for mode in ("binary", "binary_compressed"):
    pcdkit.from_array(points).save("scan.pcd", mode)
    show(f"pcdkit to pcdkit, {mode}", pcdkit.load_pcd_from_path("scan.pcd").pc_data)
    show(f"pcdkit to pypcd4, {mode}", pypcd4.PointCloud.from_path("scan.pcd").numpy())

cloud = pypcd4.PointCloud.from_points(np.array(points.tolist(), np.float32), NAMES, [np.float32] * 4)
cloud.save("other.pcd", encoding=pypcd4.Encoding.BINARY_COMPRESSED)
show("pypcd4 to pcdkit, binary_compressed", pcdkit.load_pcd_from_path("other.pcd").pc_data)
END
venv/bin/python compressed.py >seen

cat >expected <<'END'
pcdkit to pcdkit, binary: [(1.0, 2.0, 3.0, 10.0), (4.0, 5.0, 6.0, 20.0), (7.0, 8.0, 9.0, 30.0)]
pcdkit to pypcd4, binary: [(1.0, 2.0, 3.0, 10.0), (4.0, 5.0, 6.0, 20.0), (7.0, 8.0, 9.0, 30.0)]
pcdkit to pcdkit, binary_compressed: [(1.0, 10.0, 6.0, 8.0), (2.0, 4.0, 20.0, 9.0), (3.0, 5.0, 7.0, 30.0)]
pcdkit to pypcd4, binary_compressed: [(1.0, 10.0, 6.0, 8.0), (2.0, 4.0, 20.0, 9.0), (3.0, 5.0, 7.0, 30.0)]
pypcd4 to pcdkit, binary_compressed: [(1.0, 2.0, 3.0, 10.0), (4.0, 5.0, 6.0, 20.0), (7.0, 8.0, 9.0, 30.0)]
END
diff expected seen || { echo "CHANGED: pcdkit-shuffles-compressed" >&2; exit 1; }
echo "PASS: what pcdkit compresses comes back shuffled"
