#!/bin/sh
# SPDX-License-Identifier: MIT
# bno055_usb_stick_py finds its stick only if no other tty is listed before it, and inside of a with block the stick
# is None.
#
# Version:   bno055_usb_stick_py 0.9.5, pyserial 3.5.
# Expected:  The stick is found among the devices, and with BnoUsbStick() as stick: gives it and closes it at the end.
# Behaviour: The search raises the error that the stick was not detected at the first device that is not one. A with
#            block gets None, and its end raises TypeError, also after an error inside of it, which is hidden by this
#            one.
# Hurts:     Anyone who has a second serial device, such as the robot, on the same computer, or closes ports by with.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            bno055_usb_stick_py==0.9.5 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >stick.py <<'END'
import sys
import types

import serial

STICK = {"ID_MODEL": "Bosch_Sensortec_BNO_stick", "ID_VENDOR": "Bosch_Sensortec"}


class Device(dict):
    def __init__(self, node, **values):
        super().__init__(**values)
        self.device_node = node


class Port:
    """A serial port on which nothing comes."""

    is_open = False

    def open(self):
        self.is_open = True

    def close(self):
        self.is_open = False

    def write(self, data):
        return len(data)

    def read(self, size):
        return b"\xaa"[: self.is_open and 0]


pyudev = sys.modules["pyudev"] = types.ModuleType("pyudev")
serial.Serial = Port

from bno055_usb_stick_py import BnoUsbStick

BnoUsbStick.__del__ = lambda self: None
robot, stick = Device("/dev/ttyUSB0", ID_MODEL="robot"), Device("/dev/ttyACM0", **STICK)
for name, devices in (("stick, robot", [stick, robot]), ("robot, stick", [robot, stick])):
    pyudev.Context = lambda devices=devices: types.SimpleNamespace(list_devices=lambda subsystem: devices)
    try:
        print(f"{name}: {BnoUsbStick().port_name}")
    except Exception as error:
        print(f"{name}: {error.message}")
try:
    with BnoUsbStick(port="/dev/ttyACM0") as stick:
        print("in the block:", stick)
        raise RuntimeError("no answer")
except TypeError as error:
    print("at its end:", error)
END
venv/bin/python stick.py >seen

cat >expected <<'END'
stick, robot: /dev/ttyACM0
robot, stick: BNO USB Stick not detected!
in the block: None
at its end: BnoUsbStick.__exit__() takes 1 positional argument but 4 were given
END
diff expected seen || { echo "CHANGED: bno055-usb-stick-first-tty-only" >&2; exit 1; }
echo "PASS: with the robot listed first the stick is not detected"
