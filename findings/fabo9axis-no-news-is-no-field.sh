#!/bin/sh
# SPDX-License-Identifier: MIT
# Between two measurements FaBo9Axis_MPU9250 reports a magnetic field of 0, 0, 0, and in a strong field too: a robot
# that asks often heads for 0 degrees.
#
# Version:   FaBo9Axis_MPU9250_Python3 1.0.3.
# Expected:  readMagnet waits for a measurement, or returns the last one, or raises an error.
# Behaviour: The compass measures eight times a second. If nothing new is there, or the sensor reports an overflow, the
#            three numbers stay at the zeros they began with.
# Hurts:     Anyone who asks for the heading in a loop at more than 8 Hz: most of the headings are atan2(0, 0).
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            FaBo9Axis_MPU9250_Python3==1.0.3 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >compass.py <<'END'
import math
import struct
import sys
import time
import types

clock = {"now": 0.0, "read": -1}  # seconds, made by us
overflow = False


class Bus:
    """An MPU-9250 whose compass measures at 8 Hz in a field of 20 microtesla to the north and 20 to the east."""

    def __init__(self, number):
        pass

    def write_byte_data(self, address, register, value):
        pass

    def read_byte_data(self, address, register):
        return int(int(clock["now"] * 8) != clock["read"])  # ST1: is there anything new?

    def read_i2c_block_data(self, address, register, count):
        if register == 0x10:
            return [128] * 3  # no correction
        clock["read"] = int(clock["now"] * 8)
        return list(struct.pack("<hhhB", 133, 133, -300, 0x08 if overflow else 0))


sys.modules["smbus"] = types.ModuleType("smbus")
sys.modules["smbus"].SMBus = Bus
time.sleep = lambda seconds: None

from FaBo9Axis_MPU9250.MPU9250 import MPU9250

sensor = MPU9250()
for step in range(5):
    clock["now"] += 0.05
    field = sensor.readMagnet()
    print(f"{clock['now']:.2f} s: {field['x']:.1f}, {field['y']:.1f}, {field['z']:.1f}, heading {math.degrees(math.atan2(field['y'], field['x'])):.0f}")
overflow, clock["now"] = True, 1.0
print("overflow:", sensor.readMagnet())
END
venv/bin/python compass.py >seen

cat >expected <<'END'
0.05 s: 19.9, 19.9, -45.0, heading 45
0.10 s: 0.0, 0.0, 0.0, heading 0
0.15 s: 19.9, 19.9, -45.0, heading 45
0.20 s: 0.0, 0.0, 0.0, heading 0
0.25 s: 19.9, 19.9, -45.0, heading 45
overflow: {'x': 0, 'y': 0, 'z': 0}
END
diff expected seen || { echo "CHANGED: fabo9axis-no-news-is-no-field" >&2; exit 1; }
echo "PASS: two of five headings at 20 Hz are those of no field"
