#!/bin/sh
# SPDX-License-Identifier: MIT
# rplidar-roboticia gives each point of an express scan the bearing of the next one, and begins a turn up to 31 points
# early.
#
# Version:   rplidar-roboticia 0.9.5, pyrplidar 0.1.2, pyserial 3.5.
# Expected:  The first of the 32 points of an express packet lies at the start angle that the packet names, and a turn
#            begins where the bearing passes 0. pyrplidar reads the same bytes so.
# Behaviour: The first point is placed one step further, 0.9 degrees with 400 points a turn, 94 mm at 6 m. A new turn
#            is flagged at the first point of the packet in which it begins: at 346, 332 and so on degrees, so that
#            each scan holds points of the turn before.
# Hurts:     Anyone who maps, or compares a laser with another sensor, in express mode: walls are turned, and what
#            moves is seen at two times in one scan.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            rplidar-roboticia==0.9.5 \
            pyrplidar==0.1.2 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >express.py <<'END'
import contextlib
import io
import itertools
import os
import pty
import struct
import threading
import tty

import pyrplidar
import rplidar
import serial

serial.Serial._update_dtr_state = lambda self: None  # a pty has no such line
STEP = 0.9  # degrees between two points, 400 in a turn; the distance of a point is 1000 + its number


def packet(first):
    """Return an express packet of 32 points, no correction of angle."""
    start = round(first % 400 * STEP * 64)
    body = struct.pack("<H", start | (0x8000 if first == 0 else 0))
    for point in range(first, first + 32, 2):
        one, other = 1000 + point % 400, 1000 + (point + 1) % 400
        body += struct.pack("<HHB", one << 2, other << 2, 0)
    check = 0
    for byte in body:
        check ^= byte
    return bytes([0xA0 | check & 15, 0x50 | check >> 4]) + body


def laser():
    """Return the name of a pty where an RPLIDAR answers, and its open end."""
    end, other = pty.openpty()
    tty.setraw(end)
    tty.setraw(other)

    def serve():
        rest = b""
        while True:
            rest += os.read(end, 256)
            while len(rest) >= 2:
                size = 4 + rest[2] if rest[1] & 0x80 and len(rest) > 2 else 2
                if rest[1] & 0x80 and len(rest) < max(size, 4):
                    break
                order, rest = rest[1], rest[size:]
                if order == 0x52:  # health
                    os.write(end, b"\xa5\x5a" + struct.pack("<IB", 3, 6) + bytes(3))
                if order == 0x82:  # express scan
                    os.write(end, b"\xa5\x5a" + struct.pack("<IB", 84 | 0x40000000, 0x82))
                    for number in range(30):
                        os.write(end, packet(32 * number))

    threading.Thread(target=serve, daemon=True).start()
    return os.ttyname(other), other


name, keep = laser()
points = list(itertools.islice(rplidar.RPLidar(name).iter_measures("express", max_buf_meas=False), 880))
print("rplidar: points 0 and 1 at", [round(p[2], 1) for p in points[:2]], "degrees")
print("rplidar: a turn begins at point", [int(p[3]) - 1000 for p in points if p[0]])
name, keep_too = laser()
device = pyrplidar.PyRPlidar()
with contextlib.redirect_stdout(io.StringIO()):
    device.connect(name)
points = list(itertools.islice(device.start_scan_express(0)(), 880))
print("pyrplidar: points 0 and 1 at", [round(p.angle, 1) for p in points[:2]], "degrees")
print("pyrplidar: a turn begins at point", [int(p.distance) - 1000 for p in points if p.start_flag])
print(end="", flush=True)
os._exit(0)
END
venv/bin/python express.py >seen

cat >expected <<'END'
rplidar: points 0 and 1 at [0.9, 1.8] degrees
rplidar: a turn begins at point [384, 368]
pyrplidar: points 0 and 1 at [0.0, 0.9] degrees
pyrplidar: a turn begins at point [399, 399]
END
diff expected seen || { echo "CHANGED: rplidar-express-one-point-on" >&2; exit 1; }
echo "PASS: point 0, at 0 degrees, is placed at 0.9"
