#!/bin/sh
# SPDX-License-Identifier: MIT
# pixycamev3 reports an object that leans 30 degrees to the left at 65506, and the branches of a crossing by its
# coordinates.
#
# Version:   pixycamev3 1.0.0.
# Expected:  The angle of a block is signed, and the first branch of a crossing has the index and the angle that the
#            camera sent.
# Behaviour: Signed numbers are put together without a sign. The branches are looked up from the first byte of the
#            crossing on, where its place is, and all their angles come from one byte, as an index was written 14
#            instead of i4.
# Hurts:     Anyone who steers by colour codes or by lines: left is far to the right, and a crossing has no branch in
#            the direction in which one is.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            pixycamev3==1.0.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >camera.py <<'END'
import struct
import sys
from unittest.mock import MagicMock, patch

for name in ("smbus", "ev3dev2", "ev3dev2.sensor", "ev3dev2.port"):
    sys.modules[name] = MagicMock()
with patch("os.listdir", return_value=[]):  # no file tells which computer this is
    from pixycamev3.pixy2 import Pixy2


class Bus:
    """A camera with one answer."""

    def __init__(self, kind, payload):
        self.stream = struct.pack("<HBBH", 0xC1AF, kind, len(payload), sum(payload)) + payload

    def write_i2c_block_data(self, address, register, data):
        pass

    def read_i2c_block_data(self, address, register, count):
        data, self.stream = self.stream[:count], self.stream[count:]
        return data


camera = Pixy2.__new__(Pixy2)
camera.i2c_address = 0x54
camera.pixy2 = Bus(33, struct.pack("<5HhBB", 12, 158, 104, 20, 20, -30, 1, 9))
_, blocks = camera.get_blocks(255, 1)
print("a block at -30 degrees:", blocks[0].angle)

# A crossing at 39, 26 with branches 5 at -90, 6 at 0 and 7 at 90 degrees, and room for three more
branches = b"".join(struct.pack("<BBh", *one) for one in ((5, 0, -90), (6, 0, 0), (7, 0, 90), *[(0, 0, 0)] * 3))
crossing = bytes([39, 26, 3, 0]) + branches
camera.pixy2 = Bus(49, bytes([2, len(crossing)]) + crossing)
features = camera.get_linetracking_data()
print("branches 5 at -90, 6 at 0, 7 at 90:", [(one.index, one.angle) for one in features.intersections[0].branches])
END
venv/bin/python camera.py >seen

cat >expected <<'END'
a block at -30 degrees: 65506
branches 5 at -90, 6 at 0, 7 at 90: [(39, 0), (5, 0), (6, 0)]
END
diff expected seen || { echo "CHANGED: pixycamev3-turn-to-the-left" >&2; exit 1; }
echo "PASS: -30 degrees are 65506, and branch 5 is number 39"
