#!/bin/sh
# SPDX-License-Identifier: MIT
# hybo reads 5 ms after the second as half a second after it, and never calls the function that start() was given.
#
# Version:   hybo 0.0.1, pyserial 3.5, numpy 2.4.6.
# Expected:  Each frame has a later time than the one before, and is passed to the callback.
# Behaviour: The seconds and the milliseconds of the laser are joined by a point, without zeros: 12 s and 5 ms is 12.5,
#            as 12 s and 500 ms are, and 12 s and 95 ms is later than 12 s and 100 ms. The callback is kept and not
#            called: only get_latest_frame() has the scan.
# Hurts:     Anyone who lines up scans with odometry, computes a rate, or waits for scans in a callback.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            hybo==0.0.1 \
            pyserial==3.5 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >scan.py <<'END'
import struct

from hybo import HYBO_PACKET_SIZE, Lidar, LidarPacketizer


def packet(seconds, milliseconds):
    """A packet of the laser, all of its points at 0, 0, 0."""
    body = struct.pack("<HHIIII", 7, 0, seconds, milliseconds, 0, 0)
    body += bytes(HYBO_PACKET_SIZE - 4 - len(body))
    return struct.pack("<I", HYBO_PACKET_SIZE) + body + struct.pack("<I", sum(body))


called = []
lidar = Lidar("loop://")
lidar.callback = called.append  # as start() keeps it
packetizer = LidarPacketizer(lidar._on_frame)
for milliseconds in (5, 50, 95, 100, 500, 995):
    packetizer.handle_packet(packet(12, milliseconds))
    print(f"12 s and {milliseconds} ms: {lidar.get_latest_frame()['time_peak']}")
print("calls of the callback:", len(called))
END
venv/bin/python scan.py >seen

cat >expected <<'END'
12 s and 5 ms: 12.5
12 s and 50 ms: 12.5
12 s and 95 ms: 12.95
12 s and 100 ms: 12.1
12 s and 500 ms: 12.5
12 s and 995 ms: 12.995
calls of the callback: 0
END
diff expected seen || { echo "CHANGED: hybo-five-milliseconds-are-half-a-second" >&2; exit 1; }
echo "PASS: 12 s and 5 ms is 12.5 s"
