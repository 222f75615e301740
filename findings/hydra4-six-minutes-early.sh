#!/bin/sh
# SPDX-License-Identifier: MIT
# The points of a PandarXT-32 are up to 347 s older than their packet in hydra4: microseconds are added as seconds.
#
# Version:   hydra4 0.2.0, pypcd4 1.5.1, numpy 2.4.6.
# Expected:  The eight blocks of a packet are fired 50 us apart, so the stamps of its points lie within 0.4 ms of the
#            time that the packet carries, which is UTC.
# Behaviour: The offset of a block is a table in microseconds that is added to seconds: the first block is 346.7 s
#            before the packet, the last one 3.3 s behind it. With two returns per shot every other block is left out,
#            and the rest are 171.7 s before to 21.7 s before. The time of the packet is read as local time: in Tokyo
#            all points are nine hours older still.
# Hurts:     Anyone who removes the motion of the robot from a scan, or filters by age. Take the time of the packet, and
#            compute the offsets by hand.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            hydra4==0.2.0 \
            pypcd4==1.5.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >packet.py <<'END'
import os
import struct
import sys
import time
from datetime import datetime, timezone

from hydra4 import Hydra
from hydra4.msgs import pandar_msgs__msg__PandarPacket, pandar_msgs__msg__PandarScan, std_msgs__msg__Header
from hydra4.msgs.builtin_interfaces import builtin_interfaces__msg__Time

STAMP = builtin_interfaces__msg__Time(sec=0, nanosec=0)
NOON = datetime(2024, 6, 1, 12, tzinfo=timezone.utc)


def packet(azimuth: int, mode: int) -> pandar_msgs__msg__PandarPacket:
    """Return a packet of noon whose blocks begin at AZIMUTH and have one echo each at 5 m."""
    data = struct.pack("!BBBBH", 0xEE, 0xFF, 6, 1, 0) + bytes([32, 8, 1, 4, 1, 0])
    for block in range(8):
        data += struct.pack("<H", (azimuth + 18 * block) % 36000) + struct.pack("<HBB", 1250, 50, 0) + bytes(4 * 31)
    data += bytes(10) + struct.pack("!BHBBBBBB", mode, 600, 124, 6, 1, 12, 0, 0) + bytes(9)
    return pandar_msgs__msg__PandarPacket(stamp=STAMP, data=data, size=len(data))


for zone in ("UTC", "Asia/Tokyo"):
    os.environ["TZ"] = zone
    time.tzset()
    for name, mode in (("one return", 0x37), ("two returns", 0x39)):
        scan = pandar_msgs__msg__PandarScan(std_msgs__msg__Header(STAMP, "laser"), [packet(18000, mode), packet(18144, mode), packet(0, mode)])
        cloud = Hydra(Hydra.Model.PandarXT32).to_pypcd4(scan)[0]
        ages = [float(value) - NOON.timestamp() for value in cloud.pc_data["stamp"]]
        print(f"{zone}, {name}: {len(ages)} points, first {ages[0]:.4f} s, last {ages[-1]:.4f} s from noon")
END
venv/bin/python packet.py >seen

cat >expected <<'END'
UTC, one return: 16 points, first -346.7200 s, last 3.2800 s from noon
UTC, two returns: 8 points, first -171.7200 s, last -21.7200 s from noon
Asia/Tokyo, one return: 16 points, first -32746.7200 s, last -32396.7200 s from noon
Asia/Tokyo, two returns: 8 points, first -32571.7200 s, last -32421.7200 s from noon
END
diff expected seen || { echo "CHANGED: hydra4-six-minutes-early" >&2; exit 1; }
echo "PASS: points lie up to 347 s before their packet"
