#!/bin/sh
# SPDX-License-Identifier: MIT
# circuitpython-gp2y0e02b takes the upper and the lower part of the range from each other's register: 5 to 50 cm are
# read as at most half a centimetre.
#
# Version:   circuitpython-gp2y0e02b 0.0.1, adafruit-circuitpython-register 1.13.0.
# Expected:  30 cm in the two registers of the sensor is a distance of 30.
# Behaviour: The sensor has the upper eight bits of twelve at 0x5E and the lower four at 0x5F. The driver takes three
#            bits of the first as the lowest ones, and the rest from 16 bits at 0x5F, which has the register after it
#            in.
# Hurts:     Anyone who reads this sensor: it reports something that changes with the distance, and is next to nothing.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            circuitpython-gp2y0e02b==0.0.1 \
            adafruit-circuitpython-register==1.13.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >infrared.py <<'END'
import sys
from unittest.mock import MagicMock

SHIFT = 1


class Device:
    """A sensor at a distance of whole centimetres, whose other registers are zero."""

    def __init__(self, bus, address):
        self.raw = bus * 16 << SHIFT

    def __enter__(self):
        return self

    def __exit__(self, *reason):
        pass

    def write_then_readinto(self, out, into, out_start=0, out_end=None, in_start=0, in_end=None):
        memory = {0x5E: self.raw >> 4, 0x5F: self.raw & 15, 0x35: SHIFT}
        first = out[out_start]
        end = len(into) if in_end is None else in_end
        for index in range(in_start, end):
            into[index] = memory.get(first + index - in_start, 0)


sys.modules["busio"] = sys.modules["circuitpython_typing"] = MagicMock()
sys.modules["circuitpython_typing.device_drivers"] = MagicMock()
sys.modules["micropython"] = MagicMock(const=lambda value: value)
sys.modules["adafruit_bus_device"] = MagicMock(i2c_device=MagicMock(I2CDevice=Device))

from gp2y0e02b import GP2Y0E02B

for centimetres in (5, 7, 10, 30, 47, 50):
    print(f"{centimetres} cm:", GP2Y0E02B(centimetres).distance)
END
venv/bin/python infrared.py >seen

cat >expected <<'END'
5 cm: 0.0625
7 cm: 0.1875
10 cm: 0.125
30 cm: 0.125
47 cm: 0.1875
50 cm: 0.125
END
diff expected seen || { echo "CHANGED: gp2y0e02b-near-is-zero" >&2; exit 1; }
echo "PASS: 30 cm are read as 0.125"
