#!/bin/sh
# SPDX-License-Identifier: MIT
# mpu6050-raspberrypi joins the high byte of one sample to the low byte of the next: a turn of 2 degrees a second is
# read as 0 or 3.9.
#
# Version:   mpu6050-raspberrypi 1.2.
# Expected:  Both bytes of an axis are of one sample, which a burst read gives: the sensor holds its registers for as
#            long as one lasts.
# Behaviour: Each byte is a transfer of its own. At 100 kHz a transfer takes 0.4 ms and the gyroscope has a new sample
#            each 0.125 ms, so where a value is about a multiple of 256 counts, 1.95 degrees a second, the halves do
#            not fit, and the reading is off by that much.
# Hurts:     Anyone who integrates a heading from it: spikes of 2 degrees a second at rates that are nearly right, in
#            both directions.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            mpu6050-raspberrypi==1.2 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >turn.py <<'END'
import sys
import types


class Bus:
    """An I2C bus with a gyroscope that has a new sample at each transfer: 255, 256, 255, 256 ... counts."""

    def __init__(self, number):
        self.transfers = 0

    def write_byte_data(self, address, register, value):
        pass

    def read_byte_data(self, address, register):
        if register not in (0x43, 0x44):
            return 0
        self.transfers += 1
        counts = samples[self.transfers % len(samples)]
        return counts >> 8 if register == 0x43 else counts & 0xFF


sys.modules["smbus"] = types.ModuleType("smbus")
sys.modules["smbus"].SMBus = Bus

from mpu6050 import mpu6050

for samples in ((255, 255), (256, 256), (256, 255), (255, 256)):
    rate = mpu6050(0x68).get_gyro_data()["x"]
    print(f"samples of {samples[1] / 131:.2f} and {samples[0] / 131:.2f} deg/s: read as {rate:.2f}")
END
venv/bin/python turn.py >seen

cat >expected <<'END'
samples of 1.95 and 1.95 deg/s: read as 1.95
samples of 1.95 and 1.95 deg/s: read as 1.95
samples of 1.95 and 1.95 deg/s: read as 0.00
samples of 1.95 and 1.95 deg/s: read as 3.90
END
diff expected seen || { echo "CHANGED: mpu6050-halves-of-two-samples" >&2; exit 1; }
echo "PASS: 1.95 degrees a second is read as 0 or 3.90"
