#!/bin/sh
# SPDX-License-Identifier: MIT
# A VL53L4CD that is set to a period of 50 ms reports 49 to adafruit_vl53l4cd, which then refuses a budget of 50 ms
# for it.
#
# Version:   adafruit-circuitpython-vl53l4cd 1.3.6.
# Expected:  What was set is read back, and a budget as long as the period is right, as the text has it.
# Behaviour: The period is written with a factor of 1.055 and read with one of 1.065, and cut: each is read as one per
#            cent and up to a millisecond less. A budget that fits is too long then.
# Hurts:     Anyone who measures as often as the sensor can, or saves the settings and restores them: the period
#            shrinks each time.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            adafruit-circuitpython-vl53l4cd==1.3.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >fifty.py <<'END'
import sys
from unittest.mock import MagicMock

sys.modules["adafruit_bus_device"] = MagicMock()
sys.modules["micropython"] = MagicMock(const=lambda value: value)

from adafruit_vl53l4cd import VL53L4CD

memory = bytearray(65536)
memory[0x0006:0x0008] = (0xBCCC).to_bytes(2, "big")  # frequency of the oscillator
memory[0x00DE:0x00E0] = (0x02A6).to_bytes(2, "big")  # and of the clock of the periods


class Sensor(VL53L4CD):
    """A sensor whose registers are a piece of memory."""

    def __init__(self):
        self._ranging = False

    def _read_register(self, address, length=1):
        return bytes(memory[address : address + length])

    def _write_register(self, address, data, length=None):
        memory[address : address + len(data)] = data


sensor = Sensor()
sensor.timing_budget = 20
for period in (50, 100, 1000):
    sensor.inter_measurement = period
    print(f"period {period} ms: read {sensor.inter_measurement} ms")
    try:
        sensor.timing_budget = min(period, 200)
    except ValueError as error:
        print(f"    budget {min(period, 200)} ms: {error}")
sensor.inter_measurement = 1000
for _ in range(10):
    sensor.inter_measurement = sensor.inter_measurement
print("1000 ms, saved and restored ten times:", sensor.inter_measurement, "ms")
END
venv/bin/python fifty.py >seen

cat >expected <<'END'
period 50 ms: read 49 ms
    budget 50 ms: Timing budget can not be greater than inter-measurement period (49)
period 100 ms: read 99 ms
    budget 100 ms: Timing budget can not be greater than inter-measurement period (99)
period 1000 ms: read 990 ms
1000 ms, saved and restored ten times: 897 ms
END
diff expected seen || { echo "CHANGED: vl53l4cd-fifty-is-forty-nine" >&2; exit 1; }
echo "PASS: a period of 50 ms is read as 49"
