#!/bin/sh
# SPDX-License-Identifier: MIT
# laser_data of bagpy raises IndexError for a laser with more than 182 beams, and gives any smaller one 182.
#
# Version:   bagpy 0.5, rosbags 0.11.9 as the writer, bitstring 5.0.0, pandas 3.1.1, numpy 2.4.6.
# Expected:  A scan of 360 beams makes 360 columns of ranges, one of 5 makes 5. Scans of different lengths make one
#            table.
# Behaviour: The table has room for 182 ranges, and as many intensities, whatever the message has. A longer scan raises
#            IndexError; of a shorter one the rest is empty. message_by_topic takes the names of its columns from the
#            first message: where a later scan is longer, which is usual for lasers that turn freely, its row is longer
#            than the header, and pandas cannot read the file.
# Hurts:     Anyone who reads a laser of today by it. Read the messages themselves.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            bagpy==0.5 \
            rosbags==0.11.9 \
            bitstring==5.0.0 \
            pandas==3.1.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >scan.py <<'END'
import warnings
from pathlib import Path

import numpy as np
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_typestore

warnings.simplefilter("ignore")
store = get_typestore(Stores.ROS1_NOETIC)
Scan, Header = store.types["sensor_msgs/msg/LaserScan"], store.types["std_msgs/msg/Header"]
Time, KIND = store.types["builtin_interfaces/msg/Time"], "sensor_msgs/msg/LaserScan"


def record(name: str, *beams: int) -> None:
    """Write a bag with one scan for each number of BEAMS."""
    with Writer(Path(name)) as bag:
        topic = bag.add_connection("/scan", KIND, typestore=store)
        for second, number in enumerate(beams, 1):
            header = Header(second, Time(second, 0), "laser")
            ranges = 2 + np.arange(number, dtype=np.float32) / 4
            scan = Scan(header, -1.5, 1.5, 0.1, 0.0, 0.1, 0.5, 8.0, ranges, np.zeros(0, np.float32))
            bag.write(topic, second * 10**9, store.serialize_ros1(scan, KIND))


import pandas
from bagpy import bagreader

for beams in (5, 182, 183):
    record(f"{beams}.bag", beams)
    try:
        table = pandas.read_csv(bagreader(f"{beams}.bag", verbose=False).laser_data()[0])
        names = [name for name in table if name.startswith("ranges_")]
        print(f"{beams} beams: {len(names)} columns, {int(table[names].notna().sum(axis=1)[0])} of them filled")
    except IndexError as error:
        print(f"{beams} beams: IndexError, {error}")
record("free.bag", 4, 5)
head, *rows = Path(bagreader("free.bag", verbose=False).message_by_topic("/scan")).read_text().splitlines()
print(f"scans of 4 and 5 beams: {len(head.split(','))} names, values", *(len(row.split(",")) for row in rows))
try:
    pandas.read_csv("free/scan.csv")
except pandas.errors.ParserError:
    print("pandas cannot read them")
END
venv/bin/python scan.py >seen 2>errors || { cat errors >&2; exit 1; }

cat >expected <<'END'
5 beams: 182 columns, 5 of them filled
182 beams: 182 columns, 182 of them filled
183 beams: IndexError, list assignment index out of range
scans of 4 and 5 beams: 16 names, values 16 17
pandas cannot read them
END
diff expected seen || { echo "CHANGED: bagpy-scan-of-182" >&2; exit 1; }
echo "PASS: a laser of 183 beams raises IndexError"
