#!/bin/sh
# SPDX-License-Identifier: MIT
# ros2-numpy reads the intensity of a point from the bytes of its x, and takes the first twelve bytes for x, y, z
# whatever they are.
#
# Version:   ros2_numpy 0.0.5, transformations 2026.1.18, ROS 2 messages 5.5.1, numpy 1.24.2.
# Expected:  Each field of a PointCloud2 is read at its offset and with its type, which the message states.
# Behaviour: The number of a field in the list is taken for its offset in bytes, and two bytes for an integer:
#            intensities of 10 and 20 are 63 and 64, parts of x. Where an intensity comes first it becomes x. A cloud
#            made of points alone has a size of 0 bytes a point.
# Hurts:     Anyone who filters echoes by intensity, or whose driver has another order of fields.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            ros2_numpy==0.0.5 \
            transformations==2026.1.18 \
            numpy==1.24.2 \
            ros-rclpy==9.1.2 \
            ros-sensor-msgs==5.5.1 \
            ros-geometry-msgs==5.5.1 \
            ros-nav-msgs==5.5.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >cloud.py <<'END'
import logging
import struct

import numpy as np
import ros2_numpy
from sensor_msgs.msg import PointCloud2, PointField

logging.disable(logging.WARNING)


def cloud(*names):
    """Return two points with fields of four bytes in this order: x 1 and 4, y 2 and 5, z 3 and 6, intensity 10 and 20."""
    values = {"x": (1.0, 4.0), "y": (2.0, 5.0), "z": (3.0, 6.0), "intensity": (10.0, 20.0)}
    fields = [PointField(name=n, offset=4 * k, datatype=PointField.FLOAT32, count=1) for k, n in enumerate(names)]
    data = b"".join(struct.pack("<f", values[name][point]) for point in (0, 1) for name in names)
    return PointCloud2(height=1, width=2, point_step=16, row_step=32, is_dense=True, fields=fields, data=data)


seen = ros2_numpy.numpify(cloud("x", "y", "z", "intensity"))
print("x, y, z, intensity: points", seen["xyz"].tolist(), "intensities", seen["intensity"].ravel().tolist())
seen = ros2_numpy.numpify(cloud("intensity", "x", "y", "z"))
print("intensity, x, y, z: points", seen["xyz"].tolist())
made = ros2_numpy.msgify(PointCloud2, {"xyz": np.array([[1, 2, 3], [4, 5, 6]], np.float32)})
print(f"made of points alone: {len(made.data)} bytes, {made.point_step} a point")
END
venv/bin/python cloud.py >seen

cat >expected <<'END'
x, y, z, intensity: points [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]] intensities [63, 64]
intensity, x, y, z: points [[10.0, 1.0, 2.0], [20.0, 4.0, 5.0]]
made of points alone: 24 bytes, 0 a point
END
diff expected seen || { echo "CHANGED: ros2-numpy-cloud-by-place" >&2; exit 1; }
echo "PASS: intensities of 10 and 20 are read as 63 and 64"
