#!/bin/sh
# SPDX-License-Identifier: MIT
# The CSV of a sonar's log by mavlogdump has a quality of 0 for every reading: a list shifts the columns.
#
# Version:   mavlogdump of pymavlink 2.4.50.
# Expected:  Lists are quoted, or each of their elements has a column of its own. A value stands under its name.
# Behaviour: A list is written with its commas and without quotes. A row of DISTANCE_SENSOR has three fields more than
#            the head, and what stands under signal_quality is an element of the quaternion.
# Hurts:     Anyone who opens telemetry with lists in a spreadsheet or by the csv module: all columns behind the list
#            are wrong, and none is missing.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pymavlink==2.4.50 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - <<'END'
import struct

from pymavlink.dialects.v20 import common

link = common.MAVLink(None, 1, 1)
with open("ring.tlog", "wb") as log:
    for k in range(3):
        echo = common.MAVLink_distance_sensor_message(k, 20, 700, 100 + k, 0, k, 0, 255, 0.5, 0.5, [1, 0, 0, 0], 90 + k)
        log.write(struct.pack(">Q", 1700000000000000 + k * 100000) + echo.pack(link))
END
MAVLINK20=1 venv/bin/python venv/bin/mavlogdump.py --format csv --types DISTANCE_SENSOR ring.tlog >ring.csv 2>/dev/null
venv/bin/python - >seen <<'END'
import csv

for row in csv.DictReader(open("ring.csv")):
    wanted = ("current_distance", "quaternion", "signal_quality")
    print(*(f"{name}={row['DISTANCE_SENSOR.' + name]}" for name in wanted), "left over", row[None])
END

cat >expected <<'END'
current_distance=100 quaternion=[1.0 signal_quality= 0.0 left over [' 0.0', ' 0.0]', '90']
current_distance=101 quaternion=[1.0 signal_quality= 0.0 left over [' 0.0', ' 0.0]', '91']
current_distance=102 quaternion=[1.0 signal_quality= 0.0 left over [' 0.0', ' 0.0]', '92']
END
diff expected seen || { echo "CHANGED: mavlogdump-csv-columns" >&2; exit 1; }
echo "PASS: qualities of 90 to 92 stand under no name"
