#!/bin/sh
# SPDX-License-Identifier: MIT
# A ROS 1 message of the year 2040 was stamped in 1903, says rosbags, which cannot write one of 2040 either.
#
# Version:   rosbags 0.11.9.
# Expected:  Seconds of a ROS 1 time are unsigned and last until 2106. The stamp in the header is that of the bag.
# Behaviour: They are read as signed. The bag's own time is right beside it. Writing a message with such a stamp raises
#            an error.
# Hurts:     Anyone who uses the greatest time of ROS 1 as a mark for never, or a simulated clock: never becomes one
#            second before 1970.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            rosbags==0.11.9 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
import struct
from datetime import datetime, timedelta, timezone
from pathlib import Path

from rosbags.highlevel import AnyReader
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_typestore

store = get_typestore(Stores.ROS1_NOETIC)
year_2040, never = 2208988800, 2**32 - 1
with Writer("ring.bag") as bag:
    topic = bag.add_connection("/ring", "std_msgs/msg/Header", typestore=store)
    for second in (1700000000, year_2040, never):
        bag.write(topic, second * 10**9, struct.pack("<IIII5s", 7, second, 0, 5, b"sonar"))
with AnyReader([Path("ring.bag")]) as bag:
    for connection, time, raw in bag.messages():
        stamp = bag.deserialize(raw, connection.msgtype).stamp.sec
        year = (datetime(1970, 1, 1, tzinfo=timezone.utc) + timedelta(seconds=stamp)).year
        print(f"bag {time // 10**9}, header {stamp}, year {year}")
header = store.types["std_msgs/msg/Header"](7, store.types["builtin_interfaces/msg/Time"](year_2040, 0), "sonar")
try:
    store.serialize_ros1(header, "std_msgs/msg/Header")
except Exception as error:
    print("writing it raises", type(error).__name__)
END

cat >expected <<'END'
bag 1700000000, header 1700000000, year 2023
bag 2208988800, header -2085978496, year 1903
bag 4294967295, header -1, year 1969
writing it raises error
END
diff expected seen || { echo "CHANGED: rosbags-after-2038" >&2; exit 1; }
echo "PASS: 2040 is read as 1903"
