#!/bin/sh
# SPDX-License-Identifier: MIT
# In create_serial a robot that is told to turn right while it hardly advances turns left, and a hundred times slower.
#
# Version:   create_serial 0.2.1, pyserial 3.5.
# Expected:  go_differential(0.1, -2), 1 mm/s and 2 rad/s to the right, is nearly go_differential(0, -2), a turn on the
#            spot.
# Behaviour: The radius of half a millimetre is cut to 0, which stands for a turn on the spot, to the left where no
#            side is given; and the speed of the wheels is the 1 mm/s of the middle, not the 235 mm/s of the turn.
# Hurts:     Anyone who steers by a controller: near its goal the robot creeps away from it.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            create_serial==0.2.1 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >tight.py <<'END'
import struct

from create_serial.create import Create

sent = b""


def note(self, data):
    """Note what would go to the robot."""
    global sent
    sent += data


Create._write = note
robot = Create.__new__(Create)
for speed, turn in ((0, -2), (0.1, -2), (0, 2), (0.1, 2), (10, -2)):
    sent = b""
    robot.go_differential(speed, turn)
    velocity, radius = struct.unpack(">hh", sent[1:])
    what = {1: "on the spot to the left", -1: "on the spot to the right"}.get(radius, f"radius {radius} mm")
    print(f"go_differential({speed}, {turn}): {velocity} mm/s, {what}")
END
venv/bin/python tight.py >seen

cat >expected <<'END'
go_differential(0, -2): 235 mm/s, on the spot to the right
go_differential(0.1, -2): 1 mm/s, on the spot to the left
go_differential(0, 2): 235 mm/s, on the spot to the left
go_differential(0.1, 2): 1 mm/s, on the spot to the left
go_differential(10, -2): 100 mm/s, radius -50 mm
END
diff expected seen || { echo "CHANGED: create-serial-tight-right-is-left" >&2; exit 1; }
echo "PASS: 2 rad/s to the right at 1 mm/s is sent as 1 mm/s to the left"
