#!/bin/sh
# SPDX-License-Identifier: MIT
# Ranges in millimetres beyond 65535 come out of a PointCloud2 small again, without a word, and fractions are cut.
#
# Version:   pointcloud2 0.6.0, numpy 1.26.4.
# Expected:  create_cloud refuses a value that its field cannot hold, or clips it.
# Behaviour: An array with 70000.6 in a field of UINT16 becomes 4464, and 99.9 becomes 99.
# Hurts:     Anyone who puts ranges in millimetres, intensities or time offsets into integer fields of a cloud: the
#            farthest becomes the nearest.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pointcloud2==0.6.0 numpy==1.26.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
import warnings

import numpy as np
from pointcloud2 import PointField, create_cloud, read_points

warnings.simplefilter("error")
fields = [PointField("x", 0, PointField.FLOAT32, 1), PointField("range", 4, PointField.UINT16, 1)]
points = np.array([[1.0, 99.9], [1.0, 65535.0], [1.0, 70000.6]])
print(*read_points(create_cloud(None, fields, points))["range"])
END

cat >expected <<'END'
99 65535 4464
END
diff expected seen || { echo "CHANGED: pointcloud2-wraps" >&2; exit 1; }
echo "PASS: 70000.6 mm become 4464"
