#!/bin/sh
# SPDX-License-Identifier: MIT
# lds2d keeps the low byte of the intensity of an LDS-01: a strong echo of 512 counts is one of 0.
#
# Version:   lds2d 0.7.0.
# Expected:  The 16 bits of the laser of a TurtleBot3 are scaled or limited to 255.
# Behaviour: The high byte is dropped: 255, 256, 511, 512 are 255, 0, 255, 0.
# Hurts:     Anyone who looks for reflectors or drops weak echoes by the quality: the best are lost.
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

cat >strong.py <<'END'
import struct

from lds2d import Lidar


def packet(number, echoes):
    """Return a packet of six points at 1 m."""
    body = struct.pack("<BBH", 0xFA, 0xA0 + number, 300) + b"".join(struct.pack("<HHH", echo, 1000, 0) for echo in echoes)
    check = 0
    for word in struct.unpack("<20H", body):
        check = (check << 1) + word
    return body + struct.pack("<H", (check & 0x7FFF) + (check >> 15) & 0x7FFF)


class Line:
    """A serial line on which one packet was received."""

    data = packet(0, (100, 255, 256, 511, 512, 2060))

    def read(self, size):
        if not self.data:
            raise EOFError
        data, self.data = self.data[:size], self.data[size:]
        return data


seen = []
try:
    for point in Lidar.open("LDS-01", transport=Line()).points():
        seen.append(point.quality)
except EOFError:
    print("intensities 100, 255, 256, 511, 512, 2060: quality", seen)
END
venv/bin/python strong.py >seen

cat >expected <<'END'
intensities 100, 255, 256, 511, 512, 2060: quality [100, 255, 0, 255, 0, 12]
END
diff expected seen || { echo "CHANGED: lds2d-strong-echo-is-weak" >&2; exit 1; }
echo "PASS: an intensity of 512 is a quality of 0"
