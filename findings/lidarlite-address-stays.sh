#!/bin/sh
# SPDX-License-Identifier: MIT
# adafruit_lidarlite promises to give the laser another address and does not: it looks for one that has it already.
#
# Version:   adafruit-circuitpython-lidarlite 1.3.14, adafruit-circuitpython-busdevice 5.2.17.
# Expected:  LIDARLite(bus, address=0x44) changes the address of the laser at 0x62, so that several can share a bus, as
#            its description says.
# Behaviour: No register of the address is written and none of the serial number is read. The laser at 0x62 is not
#            asked at all; the program ends in the error of a device that is missing.
# Hurts:     Anyone who builds a ring of these lasers on one bus by holding all but one in reset, as the description
#            advises.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            adafruit-circuitpython-lidarlite==1.3.14 \
            adafruit-circuitpython-busdevice==5.2.17 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >address.py <<'END'
import sys
from unittest.mock import MagicMock

for name in ("busio", "digitalio", "microcontroller", "circuitpython_typing"):
    sys.modules[name] = MagicMock()
sys.modules["micropython"] = MagicMock(const=lambda value: value)

from adafruit_lidarlite import LIDARLite


class Bus:
    """A bus with one laser, which notes what is written to it."""

    def __init__(self):
        self.written, self.register = [], 0

    def try_lock(self):
        return True

    def unlock(self):
        pass

    def writeto(self, address, data, *, start=0, end=None):
        if address != 0x62:
            raise OSError("no device")
        if data := bytes(data[start:end]):
            self.written.append(data.hex())

    def readfrom_into(self, address, data, **options):
        if address != 0x62:
            raise OSError("no device")

    def writeto_then_readfrom(self, address, out, into, **options):
        into[0] = 0x20


for options in ({}, {"address": 0x44}):
    bus = Bus()
    try:
        LIDARLite(bus, **options)
        print(options, "written:", bus.written)
    except ValueError as error:
        print(options, "written:", bus.written, "ValueError,", error)
END
venv/bin/python address.py >seen

cat >expected <<'END'
{} written: ['0280', '0408', '1c00']
{'address': 68} written: [] ValueError, No I2C device at address: 0x44
END
diff expected seen || { echo "CHANGED: lidarlite-address-stays" >&2; exit 1; }
echo "PASS: a new address is looked for, not set"
