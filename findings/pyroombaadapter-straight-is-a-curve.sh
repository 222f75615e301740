#!/bin/sh
# SPDX-License-Identifier: MIT
# pyroombaadapter told to drive straight drives a curve of 2 m radius, and turns twice as far as asked in a wide one.
#
# Version:   pyroombaadapter 0.3.0.
# Expected:  A yaw rate of 0 sends the radius 32768 that means straight in iRobot's Open Interface; 0.2 m/s with 0.05
#            rad/s, a radius of 4 m, turns 0.05 rad in a second or is refused.
# Behaviour: Every radius is cut to 2000 mm, the mark for straight too. Straight becomes a curve to the left, 29
#            degrees after one metre.
# Hurts:     Anyone who drives a Roomba or Create along a wall or computes odometry from the speeds asked for.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pyroombaadapter==0.3.0 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >straight.py <<'END'
import contextlib
import io
import struct

import serial


class Port:
    """A serial port with a Roomba behind it that notes what it receives."""

    def __init__(self, *args, **kwargs):
        self.sent = b""

    def isOpen(self):
        return True

    def write(self, data):
        self.sent += data

    def close(self):
        pass


serial.Serial = Port
from pyroombaadapter import PyRoombaAdapter

with contextlib.redirect_stdout(io.StringIO()):
    robot = PyRoombaAdapter("roomba")
for speed, yaw in ((0.2, 0.0), (-0.2, 0.0), (0.2, 0.05), (0.2, 0.2)):
    robot.serial_con.sent = b""
    robot.move(speed, yaw)
    sent = robot.serial_con.sent
    velocity, radius = struct.unpack(">hh", sent[1:])
    print(f"move({speed}, {yaw}): {sent.hex(' ')}, {velocity} mm/s on a radius of {radius} mm, {velocity / radius:+.2f} rad/s")
END
venv/bin/python straight.py >seen

cat >expected <<'END'
move(0.2, 0.0): 89 00 c8 07 d0, 200 mm/s on a radius of 2000 mm, +0.10 rad/s
move(-0.2, 0.0): 89 ff 38 07 d0, -200 mm/s on a radius of 2000 mm, -0.10 rad/s
move(0.2, 0.05): 89 00 c8 07 d0, 200 mm/s on a radius of 2000 mm, +0.10 rad/s
move(0.2, 0.2): 89 00 c8 03 e8, 200 mm/s on a radius of 1000 mm, +0.20 rad/s
END
diff expected seen || { echo "CHANGED: pyroombaadapter-straight-is-a-curve" >&2; exit 1; }
echo "PASS: straight ahead is sent as a radius of 2000 mm"
