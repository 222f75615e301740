#!/bin/sh
# SPDX-License-Identifier: MIT
# The right infrared receiver of serialroomba is the left one, and either raises an error where no beam is seen.
#
# Version:   serialroomba 0.1.2.
# Expected:  infrared_opcode_right asks for packet 53 and is None, or a code of its own, without a beam.
# Behaviour: Both ask for packet 52. The robot sends 0 where there is no beam, and 0 is not among the codes: the
#            property raises ValueError.
# Hurts:     Anyone who steers to the dock by the difference of the two: there is none, and most of the time an
#            exception.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            serialroomba==0.1.2 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >eyes.py <<'END'
import serial


class Port:
    """A serial port with a Roomba behind it: red buoy (168) on the left, green (164) on the right."""

    def __init__(self, *args, **kwargs):
        self.there, self.is_open = b"", False
        self.beams = {52: 168, 53: 164}

    def open(self):
        self.is_open = True

    def write(self, data):
        if data[0] == 142:
            self.there = bytes([self.beams[data[1]]])

    def read(self, size):
        return self.there


serial.Serial = Port
from serialroomba.serialroomba import SerialRoomba

robot = SerialRoomba("roomba")
eyes = robot.environment_controller
print("left", eyes.infrared_opcode_left.name)
print("right", eyes.infrared_opcode_right.name)
robot.serial_controller.connection.beams = {52: 0, 53: 164}
for side in ("left", "right"):
    try:
        print(side, getattr(eyes, f"infrared_opcode_{side}"))
    except ValueError as error:
        print(f"{side} without a beam on the left: {error}")
END
venv/bin/python eyes.py >seen

cat >expected <<'END'
left DOCK_RED_BUOY
right DOCK_RED_BUOY
left without a beam on the left: 0 is not a valid InfraredOpCodes
right without a beam on the left: 0 is not a valid InfraredOpCodes
END
diff expected seen || { echo "CHANGED: serialroomba-right-eye" >&2; exit 1; }
echo "PASS: the right receiver reports what the left one sees"
