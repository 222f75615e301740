#!/bin/sh
# SPDX-License-Identifier: MIT
# gs2d switches off the LED of a Dynamixel with each order for the torque: it writes two bytes where the torque has one.
#
# Version:   gs2d 0.0.4, pyserial 3.5.
# Expected:  An order to switch the torque writes the byte at address 64 of the table.
# Behaviour: Two bytes are written, and the one at 65 is the LED, which becomes 0. The class has no way to switch it on
#            again.
# Hurts:     Anyone who shows by the LEDs which servo is which, or a fault: all that were on are dark after the torque
#            is on. dynamixel-sdk writes the one byte.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            gs2d==0.0.4 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >torque.py <<'END'
import time

from gs2d import RobotisP20


class Bus:
    """A bus with one servo, which stays silent."""

    def __init__(self):
        self.sent = []

    def is_open(self):
        return True

    def write(self, data):
        self.sent.append(bytes(data))

    def read(self):
        return answer(b"")

    def close(self):
        pass


def answer(parameters):
    """Return the answer of the servo 1 without an error."""
    body = bytes([0xFF, 0xFF, 0xFD, 0, 1, 4 + len(parameters), 0, 0x55, 0]) + parameters
    crc = 0
    for byte in body:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ 0x8005 if crc & 0x8000 else crc << 1) & 0xFFFF
    return body + crc.to_bytes(2, "little")


bus = Bus()
servo = RobotisP20(bus)


for on in (True, False):
    bus.sent.clear()
    servo.set_torque_enable(on, 1)
    while not bus.sent:
        time.sleep(0.01)
    (packet,) = bus.sent
    print(f"torque {on}: from address {int.from_bytes(packet[8:10], 'little')} on, data {packet[10:-2].hex(' ')}")
servo.close()
END
venv/bin/python torque.py >seen

cat >expected <<'END'
torque True: from address 64 on, data 01 00
torque False: from address 64 on, data 00 00
END
diff expected seen || { echo "CHANGED: gs2d-torque-turns-off-the-light" >&2; exit 1; }
echo "PASS: two bytes are written for the torque"
