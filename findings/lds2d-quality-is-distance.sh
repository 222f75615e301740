#!/bin/sh
# SPDX-License-Identifier: MIT
# The quality of a point of a COIN-D4A in lds2d is its distance divided by 256: the farther, the better, whatever the
# echo.
#
# Version:   lds2d 0.7.0.
# Expected:  The strength comes from the first byte of a point and the low bits of the second one, as the description
#            in the package has it.
# Behaviour: It comes from the third byte, the high part of the distance. The first is not read. The bearings of a
#            packet are steps of whole sixty-fourths of a degree, too, so that the last of 25 points is up to 0.4
#            degrees off.
# Hurts:     Anyone who drops weak echoes: the near ones go, and the far ones stay.
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

cat >quality.py <<'END'
import struct

from lds2d import Lidar


def packet(points, begin, end):
    """Return a packet of points, each a strength of 8 bits and millimetres; bearings in degrees."""
    body = b"".join(bytes([strength >> 2, (strength & 3) | (distance & 63) << 2, distance >> 6]) for strength, distance in points)
    head = struct.pack("<BBBBHH", 0xAA, 0x55, 201, len(points), round(begin * 128), round(end * 128))
    even, odd = head[0] ^ head[2] ^ head[4] ^ head[6], head[1] ^ head[3] ^ head[5] ^ head[7]
    for at in range(0, len(body), 3):
        even ^= body[at] ^ body[at + 1]
        odd ^= body[at + 2]
    return head + bytes([even, odd]) + body


class Line:
    """A serial line on which one packet was received."""

    def __init__(self, data):
        self.data = data

    def read(self, size):
        if not self.data:
            raise EOFError
        data, self.data = self.data[:size], self.data[size:]
        return data


def seen(points, begin, end):
    """Return what the driver makes of a packet."""
    found = []
    try:
        for point in Lidar.open("COIN-D4A", transport=Line(packet(points, begin, end))).points():
            found.append(point)
    except EOFError:
        return found


for strength in (4, 200):
    points = [(strength, distance) for distance in (250, 1000, 4000, 8000)]
    print(f"strength {strength}:", [f"{point.dist_mm} mm, quality {point.quality}" for point in seen(points, 10, 13)])
print("25 points from 10 to 25.36 degrees, the last at", round(seen([(200, 1000)] * 25, 10, 25.36)[-1].angle_deg, 2))
END
venv/bin/python quality.py >seen

cat >expected <<'END'
strength 4: ['250 mm, quality 0', '1000 mm, quality 3', '4000 mm, quality 15', '8000 mm, quality 31']
strength 200: ['250 mm, quality 0', '1000 mm, quality 3', '4000 mm, quality 15', '8000 mm, quality 31']
25 points from 10 to 25.36 degrees, the last at 25.0
END
diff expected seen || { echo "CHANGED: lds2d-quality-is-distance" >&2; exit 1; }
echo "PASS: 8000 mm have a quality of 31, at a strength of 4 and of 200"
