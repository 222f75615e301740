#!/bin/sh
# SPDX-License-Identifier: MIT
# A Qwiic ultrasonic sensor whose address was changed by sparkfun_qwiic_ultrasonic is looked for at an address that no
# bus has.
#
# Version:   sparkfun_qwiic_ultrasonic 2.0.0.
# Expected:  After change_address(0x25) the object talks to 0x25, and get_address returns it.
# Behaviour: The order for the sensor is the address with its highest bit set, and that is kept: 0xA5, beyond the 7
#            bits of I2C. A new object for 0x25 finds the sensor. One for an address out of the list silently takes
#            0x2F.
# Hurts:     Anyone who gives the sensors of a ring their addresses one after the other: each is lost as soon as it is
#            renamed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            sparkfun_qwiic_ultrasonic==2.0.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >address.py <<'END'
import sys
import types

sys.modules["qwiic_i2c"] = types.ModuleType("qwiic_i2c")

from qwiic_ultrasonic import QwiicUltrasonic


class Bus:
    """An I2C bus with one ultrasonic sensor that sees a wall at 700 mm."""

    at = 0x2F

    def isDeviceConnected(self, address):
        return address == self.at

    def writeCommand(self, address, command):
        if address != self.at:
            raise OSError(f"nobody at 0x{address:02X}")
        if command & 0x80:
            self.at = command & 0x7F

    def readBlock(self, address, register, size):
        return list((700).to_bytes(2, "big"))


bus = Bus()
sensor = QwiicUltrasonic(i2c_driver=bus)
print(f"at 0x{sensor.get_address():02X}: {sensor.trigger_and_read()} mm")
print("change_address(0x25):", sensor.change_address(0x25), f"- the sensor is at 0x{bus.at:02X}")
print(f"the object is at 0x{sensor.get_address():02X}, connected: {sensor.connected}")
try:
    sensor.trigger_and_read()
except OSError as error:
    print(error)
print("new object:", QwiicUltrasonic(0x25, bus).trigger_and_read(), "mm")
print(f"object for 0x30: at 0x{QwiicUltrasonic(0x30, bus).get_address():02X}")
END
venv/bin/python address.py >seen

cat >expected <<'END'
at 0x2F: 700 mm
change_address(0x25): True - the sensor is at 0x25
the object is at 0xA5, connected: False
nobody at 0xA5
new object: 700 mm
object for 0x30: at 0x2F
END
diff expected seen || { echo "CHANGED: qwiic-ultrasonic-lost-address" >&2; exit 1; }
echo "PASS: after change_address(0x25) the object looks at 0xA5"
