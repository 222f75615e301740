#!/bin/sh
# SPDX-License-Identifier: MIT
# The serial number of a LIDAR-Lite is its low byte twice in adafruit_lidarlite: 0x1234 and 0x5634 are both 0x3434.
#
# Version:   adafruit-circuitpython-lidarlite 1.3.14.
# Expected:  unit_id is the 16-bit number by which lasers of one bus are told apart and given their addresses.
# Behaviour: Two registers are read into one buffer, and both results are that buffer. The second read overwrites the
#            first before they are joined.
# Hurts:     Anyone who has several lasers on one bus: the number that unlocks a new address does not belong to any of
#            them, and one log cannot be told from another.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            adafruit-circuitpython-lidarlite==1.3.14 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >serial_number.py <<'END'
import sys
from unittest.mock import MagicMock


class Device:
    """A healthy laser with a serial number."""

    def __init__(self, bus, address):
        self.registers = {0x01: 0x20, 0x16: bus >> 8, 0x17: bus & 255, 0x0F: 1, 0x10: 44}

    def __enter__(self):
        return self

    def __exit__(self, *reason):
        pass

    def write(self, data):
        pass

    def write_then_readinto(self, out, into, out_end=None, in_end=None):
        register = out[0] & 0x7F
        for index in range(len(into) if in_end is None else in_end):
            into[index] = self.registers.get(register + index, 0)


for name in ("digitalio", "busio", "microcontroller", "adafruit_bus_device"):
    sys.modules[name] = MagicMock()
sys.modules["adafruit_bus_device.i2c_device"] = MagicMock(I2CDevice=Device)
sys.modules["micropython"] = MagicMock(const=lambda value: value)

from adafruit_lidarlite import LIDARLite

for number in (0x1234, 0x5634, 0x0034):
    laser = LIDARLite(number)
    print(f"{number:#06x} is read as {laser.unit_id:#06x}, distance {laser.distance}")
END
venv/bin/python serial_number.py >seen

cat >expected <<'END'
0x1234 is read as 0x3434, distance 300
0x5634 is read as 0x3434, distance 300
0x0034 is read as 0x3434, distance 300
END
diff expected seen || { echo "CHANGED: lidarlite-half-of-the-serial-number" >&2; exit 1; }
echo "PASS: 0x1234 is read as 0x3434"
