#!/bin/sh
# SPDX-License-Identifier: MIT
# scan_to_np of ros2-pydata returns a pair, but of a scan without echoes an array alone, and a scan without
# intensities, which the message allows, raises IndexError.
#
# Version:   ros2-pydata 0.0.2, numpy 2.4.6.
# Expected:  The function returns points and a time for each valid scan, as it is documented, and points within the
#            limits of the sensor only.
# Behaviour: If no range is finite the empty points come without the time: a program that takes two values stops with
#            ValueError. Intensities are selected by the ranges even where there are none. Ranges beyond the limits of
#            the scan, such as 0 for no echo, become points: at the sensor itself.
# Hurts:     Anyone who drives through an empty hall, or has a laser without intensities.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            ros2-pydata==0.0.2 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >scan.py <<'END'
import math
import sys
from types import SimpleNamespace
from unittest.mock import MagicMock

for module in ("cv2", "rclpy", "rclpy.clock", "rclpy.time", "builtin_interfaces", "std_msgs", "nav_msgs", "geometry_msgs", "sensor_msgs",
               "vision_msgs", "ackermann_msgs", "visualization_msgs", "sensor_msgs_py", "sensor_msgs_py.point_cloud2", "cv_bridge"):
    sys.modules[module] = MagicMock()  # for other messages
    sys.modules[f"{module}.msg"] = MagicMock()

from ros2_pydata.sensor_msgs import scan_to_np

NO = math.inf
for name, ranges, intensities in (
    ("two echoes", [1.0, NO, 2.0], [10.0, 0.0, 20.0]),
    ("no echo", [NO, NO, NO], [0.0, 0.0, 0.0]),
    ("no intensities", [1.0, NO, 2.0], []),
    ("0 for no echo, 30 beyond the limit", [0.0, 1.0, 30.0], [0.0, 10.0, 0.0]),
):
    scan = SimpleNamespace(ranges=ranges, intensities=intensities, angle_min=0.0, angle_increment=math.pi / 2, range_min=0.1, range_max=12.0)
    scan.header = SimpleNamespace(stamp=SimpleNamespace(sec=5, nanosec=0))
    try:
        points, time = scan_to_np(scan)
        print(f"{name}:", [[round(float(number), 1) + 0.0 for number in point] for point in points], "at", time)
    except (IndexError, ValueError) as error:
        print(f"{name}: {type(error).__name__}: {error}")
END
venv/bin/python scan.py >seen

cat >expected <<'END'
two echoes: [[1.0, 0.0, 10.0], [-2.0, 0.0, 20.0]] at 5.0
no echo: ValueError: not enough values to unpack (expected 2, got 0)
no intensities: IndexError: boolean index did not match indexed array along axis 0; size of axis is 0 but size of corresponding boolean axis is 3
0 for no echo, 30 beyond the limit: [[0.0, 0.0, 0.0], [0.0, 1.0, 10.0], [-30.0, 0.0, 0.0]] at 5.0
END
diff expected seen || { echo "CHANGED: ros2-pydata-scan-without-echo" >&2; exit 1; }
echo "PASS: a scan without echoes is not a pair"
