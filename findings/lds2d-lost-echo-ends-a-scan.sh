#!/bin/sh
# SPDX-License-Identifier: MIT
# With lds2d each point without echo near bearing 0 begins a new scan of a YDLIDAR: one turn is cut into many.
#
# Version:   lds2d 0.7.0.
# Expected:  One scan for each turn. The laser marks its begin in the type of a packet.
# Behaviour: The mark is not used: a scan ends where the bearing drops by more than 180 degrees. Bearings are corrected
#            by the parallax, at 2 m by -7.4 degrees, and by nothing where there is no echo, so that lost echoes in the
#            first 7 degrees jump from 355 to 3 degrees and back.
# Hurts:     Anyone with dark or far things ahead: scans of one or two points, and a turn is missed or counted many
#            times.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            lds2d==0.7.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >echo.py <<'END'
import struct

from lds2d import Lidar


def turn(lost):
    """Return the packets of a turn of 360 points of an X4 at 7 Hz, walls at 2 m; lost are the bearings without echo."""
    packets = b""
    for first in range(0, 360, 40):
        ranges = [0 if first + i in lost else 2000 * 4 for i in range(40)]
        begin, end = first * 128 | 1, (first + 39) * 128 | 1
        kind = (70 << 1 | 1) if first == 0 else 0
        check = 0x55AA ^ begin ^ end ^ (kind | 40 << 8)
        for value in ranges:
            check ^= value
        packets += struct.pack("<HBBHHH40H", 0x55AA, kind, 40, begin, end, check, *ranges)
    return packets


class Line:
    """A serial line on which turns were received."""

    def __init__(self, data):
        self.data = data

    def read(self, size):
        if not self.data:
            raise EOFError
        data, self.data = self.data[:size], self.data[size:]
        return data


for lost in ([], [180], [2, 4], [1, 3, 5]):
    sizes = []
    try:
        for scan in Lidar.open("YDLIDAR_X4", transport=Line(turn(lost) * 5)).scans():
            sizes.append(len(scan))
    except EOFError:
        print(f"no echo at {lost}: 5 turns of 360 points, scans of {sizes} points")
END
venv/bin/python echo.py >seen

cat >expected <<'END'
no echo at []: 5 turns of 360 points, scans of [8, 360, 360, 360, 360] points
no echo at [180]: 5 turns of 360 points, scans of [8, 360, 360, 360, 360] points
no echo at [2, 4]: 5 turns of 360 points, scans of [2, 2, 4, 354, 2, 4, 354, 2, 4, 354, 2, 4, 354, 2, 4] points
no echo at [1, 3, 5]: 5 turns of 360 points, scans of [1, 2, 2, 3, 353, 2, 2, 3, 353, 2, 2, 3, 353, 2, 2, 3, 353, 2, 2, 3] points
END
diff expected seen || { echo "CHANGED: lds2d-lost-echo-ends-a-scan" >&2; exit 1; }
echo "PASS: three lost echoes ahead cut each turn into four scans"
