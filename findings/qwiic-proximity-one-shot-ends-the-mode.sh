#!/bin/sh
# SPDX-License-Identifier: MIT
# In sparkfun_qwiic_proximity the first single measurement ends the mode that it needs, smart persistence is never
# switched on, and the white channel never off.
#
# Version:   sparkfun_qwiic_proximity 0.9.0.
# Expected:  Each switch sets and clears its own bit of the VCNL4040, and no other.
# Behaviour: A trigger clears bit 3, which is the mode in which triggers count, where bit 2 was meant. Smart
#            persistence clears bit 4 and sets bit 1, which is reserved. Both methods of the white channel write the
#            same value.
# Hurts:     Anyone who measures on demand to save energy: there is one reading, and after it the sensor runs on its
#            own.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            sparkfun_qwiic_proximity==0.9.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >switches.py <<'END'
import sys
from unittest.mock import MagicMock

sys.modules["qwiic_i2c"] = MagicMock()

from qwiic_proximity import QwiicProximity


class Bus:
    """A VCNL4040 whose bits stay as they were written."""

    def __init__(self):
        self.words = [0] * 16

    def readWord(self, address, register):
        return self.words[register]

    def writeWord(self, address, register, word):
        self.words[register] = word


def bits(bus):
    """The two bytes of register 4: PS_CONF3 and PS_MS."""
    return f"PS_CONF3 {bus.words[4] & 255:08b}, PS_MS {bus.words[4] >> 8:08b}"


bus = Bus()
sensor = QwiicProximity(i2c_driver=bus)
for name in ("enable_active_force_mode", "take_single_prox_measurement"):
    getattr(sensor, name)()
    print(f"{name}: {bits(bus)}")
for name in ("enable_smart_persistance", "disable_white_channel"):
    bus = Bus()
    getattr(QwiicProximity(i2c_driver=bus), name)()
    print(f"{name} alone: {bits(bus)}")
END
venv/bin/python switches.py >seen

cat >expected <<'END'
enable_active_force_mode: PS_CONF3 00001000, PS_MS 00000000
take_single_prox_measurement: PS_CONF3 00000100, PS_MS 00000000
enable_smart_persistance alone: PS_CONF3 00000010, PS_MS 00000000
disable_white_channel alone: PS_CONF3 00000000, PS_MS 00000000
END
diff expected seen || { echo "CHANGED: qwiic-proximity-one-shot-ends-the-mode" >&2; exit 1; }
echo "PASS: a single measurement leaves 00000100 of 00001100"
