#!/bin/sh
# SPDX-License-Identifier: MIT
# PyLidar3 averages a point without echo as one at 0 mm: half of the points lost, and a wall at 2 m is reported at 1
# m.
#
# Version:   PyLidar3 1.6, pyserial 3.5.
# Expected:  0 means that the laser heard nothing; the range of a degree is the mean of its echoes.
# Behaviour: All points that fall into a degree are averaged, zeros too. The documentation of the function promises
#            meters; it returns whole millimetres.
# Hurts:     Anyone whose YDLIDAR X4 or G4 looks at dark, shiny or grazing surfaces: obstacles appear that are not
#            there, at any range below the true one.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            PyLidar3==1.6 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >wall.py <<'END'
import struct

from PyLidar3 import YdLidarX4


class Port:
    """A serial port with the answer to the order to scan, then packets."""

    def __init__(self, packets):
        self.stream = packets

    def read(self, count):
        if count == 7:
            return bytes(7)
        return self.stream

    def write(self, order):
        pass

    def reset_input_buffer(self):
        pass

    def setDTR(self, on):
        pass


def packet(ranges_mm):
    """Return a packet whose points lie from 10.1 to 10.9 degrees, the correction for the place of the lens taken off."""
    first, last = 10.1, 10.9
    ends = [YdLidarX4._AngleCorr(ranges_mm[0]), YdLidarX4._AngleCorr(ranges_mm[-1])]
    body = struct.pack(
        "<BBHH",
        0,
        len(ranges_mm),
        round((first - ends[0]) * 64) << 1 | 1,
        round((last - ends[1]) * 64) << 1 | 1,
    )
    samples = b"".join(struct.pack("<H", mm * 4) for mm in ranges_mm)
    check = 0x55AA
    for part in struct.unpack(f"<{3 + len(ranges_mm)}H", body + samples):
        check ^= part
    return b"\xaa\x55" + body + struct.pack("<H", check) + samples


for name, ranges_mm in (
    ("all points heard", [2000] * 8),
    ("one of four lost", [2000, 0, 2000, 2000, 2000, 0, 2000, 2000]),
    ("half of them lost", [2000, 0, 0, 2000, 2000, 0, 0, 2000]),
):
    laser = YdLidarX4("none")
    laser._is_connected = True
    laser._s = Port(packet(ranges_mm) * 6)
    print(f"{name}: {next(laser.StartScanning())[10]} at 10 degrees")
END
venv/bin/python wall.py >seen

cat >expected <<'END'
all points heard: 2000 at 10 degrees
one of four lost: 1500 at 10 degrees
half of them lost: 1000 at 10 degrees
END
diff expected seen || { echo "CHANGED: pylidar3-silence-is-averaged" >&2; exit 1; }
echo "PASS: a wall at 2000 mm is reported at 1000"
