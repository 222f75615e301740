#!/bin/sh
# SPDX-License-Identifier: MIT
# lds2d never completes a scan of a Neato XV11 or an LDS01RR: their points pile up in the first one.
#
# Version:   lds2d 0.7.0.
# Expected:  scans() gives a scan for each turn of the laser.
# Behaviour: A scan ends where the bearing drops by more than 180 degrees. The bearings of these two are mirrored and
#            go down, so that they jump up from 0 to 359 and never drop. points() gives them all. An LDS02RR, the same
#            packets not mirrored, has its scans.
# Hurts:     Anyone who uses the laser of a robot vacuum: the loop of the manual waits for ever, and the memory grows.
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

cat >turns.py <<'END'
import struct

from lds2d.core import driver_for
import lds2d.drivers


def turn():
    """Return the 90 packets of a turn at 5 Hz, a wall at 1 m all around."""
    packets = b""
    for index in range(90):
        body = struct.pack("<BBH", 0xFA, 0xA0 + index, 300 * 64) + struct.pack("<HH", 1000, 50) * 4
        check = 0
        for word in struct.unpack("<10H", body):
            check = (check << 1) + word
        packets += body + struct.pack("<H", (check & 0x7FFF) + (check >> 15) & 0x7FFF)
    return packets


class Line:
    """A serial line on which ten turns were received."""

    def __init__(self):
        self.data = turn() * 10

    def read(self, size):
        if not self.data:
            raise EOFError
        data, self.data = self.data[:size], self.data[size:]
        return data


def count(things):
    """Return how many come until the line ends."""
    number = 0
    try:
        for _ in things:
            number += 1
    except EOFError:
        return number


for model in ("XIAOMI_LDS02RR", "NEATO_XV11", "XIAOMI_LDS01RR"):
    driver = driver_for(model)
    lasers = []
    for _ in range(2):
        laser = driver.__new__(driver)
        laser._t = Line()
        laser._packets = lambda laser=laser: packets(laser)
        lasers.append(laser)

    def packets(laser):
        """Decode what comes, without a motor to regulate."""
        buffer = bytearray()
        while True:
            buffer += laser._t.read(256)
            yield from laser._decode(buffer)

    print(f"{model}: ten turns, {count(lasers[0].points())} points, {count(lasers[1].scans())} scans")
END
venv/bin/python turns.py >seen

cat >expected <<'END'
XIAOMI_LDS02RR: ten turns, 3600 points, 9 scans
NEATO_XV11: ten turns, 3600 points, 0 scans
XIAOMI_LDS01RR: ten turns, 3600 points, 0 scans
END
diff expected seen || { echo "CHANGED: lds2d-neato-never-a-scan" >&2; exit 1; }
echo "PASS: ten turns of a Neato XV11 are 3600 points and no scan"
