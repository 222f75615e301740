#!/bin/sh
# SPDX-License-Identifier: MIT
# In the CSV files of ros2bag-convert 5 ms after a second is written as .5000000, which is half a second.
#
# Version:   ros2bag_convert 0.1.0, numpy 2.4.6.
# Expected:  Times that are written grow as those of the bag do.
# Behaviour: The nanoseconds are put behind the point without leading zeros: 5 ms are .5000000, 50 ms are .50000000 and
#            500 ms .500000000. Read as times the three are equal, and 95 ms are later than 100 ms.
# Hurts:     Anyone who plots such a file or computes a rate: the messages of the first 100 ms of each second are at
#            another time.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            ros2bag_convert==0.1.0 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >times.py <<'END'
import contextlib
import csv
import io
import sys
from unittest.mock import MagicMock

for module in ("rcl_interfaces", "rosidl_runtime_py", "rosidl_runtime_py.utilities", "rclpy", "rclpy.serialization"):
    sys.modules[module] = MagicMock()  # for the reader of the bag

from ros2bag_convert.ros2bag_convert.save_csv_file import save_csv_file

BEGIN = 1_700_000_000 * 10**9
milliseconds = [5, 50, 95, 100, 500]
times = [BEGIN + number * 10**6 for number in milliseconds]
with contextlib.redirect_stdout(io.StringIO()):
    save_csv_file([times, [{"range": 1.5} for _ in times]], "range.csv")
for number, row in zip(milliseconds, csv.DictReader(open("range.csv"))):
    whole, point, fraction = row["time"].partition(".")
    print(f"{number} ms: written as {row['time']}, which is {float(point + fraction) * 1000:.0f} ms")
END
venv/bin/python times.py >seen

cat >expected <<'END'
5 ms: written as 2023/11/14 22:13:20.5000000, which is 500 ms
50 ms: written as 2023/11/14 22:13:20.50000000, which is 500 ms
95 ms: written as 2023/11/14 22:13:20.95000000, which is 950 ms
100 ms: written as 2023/11/14 22:13:20.100000000, which is 100 ms
500 ms: written as 2023/11/14 22:13:20.500000000, which is 500 ms
END
diff expected seen || { echo "CHANGED: ros2bag-convert-time-has-no-zeros" >&2; exit 1; }
echo "PASS: 5 ms and 500 ms are the same time"
