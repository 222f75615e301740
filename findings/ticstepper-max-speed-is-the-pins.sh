#!/bin/sh
# SPDX-License-Identifier: MIT
# circuitpython_ticstepper asks a Tic for its highest speed where the state of the pins is: 60 rpm are read as 10066,
# and limits of current by a square.
#
# Version:   circuitpython_ticstepper 2.0.4, ticlib 0.3.0, adafruit-circuitpython-register 1.13.0,
#            adafruit-circuitpython-busdevice 5.2.17.
# Expected:  What is set and what is read agree, and both libraries ask for the same bytes.
# Behaviour: The offsets of the settings are used in the order that reads variables. ticlib has the highest speed at
#            0x16 and its limit of current at 0x4A, circuitpython_ticstepper at 0x47 and 0x40. Besides, a limit is read
#            back as its number squared: a Tic 36v4 set to 2 A reports 125 A.
# Hurts:     Anyone who checks what a motor was set to before it turns a sensor.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            circuitpython_ticstepper==2.0.4 \
            ticlib==0.3.0 \
            adafruit-circuitpython-register==1.13.0 \
            adafruit-circuitpython-busdevice==5.2.17 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >tic.py <<'END'
import struct
import sys
import types
from unittest.mock import MagicMock

sys.modules["micropython"] = types.ModuleType("micropython")
sys.modules["micropython"].const = lambda value: value
for module in ("circuitpython_typing", "circuitpython_typing.device_drivers", "busio", "smbus2"):
    sys.modules[module] = MagicMock()  # for the types of arguments

from circuitpython_ticstepper.tic36v4 import TIC36v4_I2C
from ticlib import ticlib

VARIABLES = bytearray(0x60)
struct.pack_into("<I", VARIABLES, 0x16, 2_000_000)  # highest speed, in steps in 10000 s: 60 rpm
VARIABLES[0x4A] = 20  # limit of current


class Bus:
    """An I2C bus with a Tic that answers from VARIABLES, at the offset it was asked for last."""

    def try_lock(self):
        return True

    def unlock(self):
        pass

    def writeto(self, address, data, **limits):
        if bytes(data[:1]) == b"\xa1":
            self.offset = data[1]
            asked.append(hex(self.offset))

    def writeto_then_readfrom(self, address, out, into, *, out_start=0, out_end=None, in_start=0, in_end=None):
        end = len(into) if in_end is None else in_end
        into[in_start:end] = VARIABLES[self.offset : self.offset + end - in_start]


asked = []
tic = TIC36v4_I2C(Bus())
asked.clear()
print(f"highest speed: {tic.max_speed:.0f} rpm, asked for at", asked.pop())
tic.current_limit
print("limit of current: asked for at", asked.pop())
print("ticlib:", *(f"{name} at {hex(offset)}" for name, offset, *_ in ticlib.VARIABLES if name in ("max_speed", "current_limit")))
number = tic.convert_current_value(2.0)
print(f"2 A are set as {number}, which is read as {tic.convert_current_enum(number):.1f} A")
END
venv/bin/python tic.py >seen

cat >expected <<'END'
highest speed: 10066 rpm, asked for at 0x47
limit of current: asked for at 0x40
ticlib: max_speed at 0x16 current_limit at 0x4a
2 A are set as 63, which is read as 125.0 A
END
diff expected seen || { echo "CHANGED: ticstepper-max-speed-is-the-pins" >&2; exit 1; }
echo "PASS: 60 rpm are read as 10066 rpm"
