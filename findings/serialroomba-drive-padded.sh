#!/bin/sh
# SPDX-License-Identifier: MIT
# serialroomba pads and swaps what it sends: 300 mm/s is received as 44 mm/s and a surplus byte.
#
# Version:   serialroomba 0.1.2, on a machine with little-endian numbers.
# Expected:  A drive command is the five bytes 137, speed and radius with the high byte first, as iRobot's Open
#            Interface has it.
# Behaviour: It is packed as a structure of the machine: six bytes, a zero after the first one and the low bytes first.
#            The robot takes five of them for the command, and the sixth for the next one. Values of two bytes are read
#            with swapped bytes as well: a radius of 500 mm is -3071.
# Hurts:     Anyone who drives a Roomba or Create with it.
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

cat >drive.py <<'END'
import struct

import serial


class Port:
    """A serial port with a Roomba behind it: any value it is asked for is 500."""

    def __init__(self, *args, **kwargs):
        self.sent, self.there, self.is_open = b"", b"", False

    def open(self):
        self.is_open = True

    def write(self, data):
        self.sent += data
        if data[0] == 142:
            self.there = struct.pack(">h", 500)

    def read(self, size):
        data, self.there = self.there[:size], self.there[size:]
        return data


serial.Serial = Port
from serialroomba.controllers.movement import MovementCommand
from serialroomba.serialroomba import SerialRoomba

robot = SerialRoomba("roomba")
port = robot.serial_controller.connection
port.sent = b""
robot.movement_controller.send_command(MovementCommand.DRIVE, [300, 500])
print("300 mm/s, 500 mm:", port.sent.hex(" "))
print("as the robot reads it: %d mm/s, %d mm" % struct.unpack(">hh", port.sent[1:5]), "and", port.sent[5:].hex(" "))
print("by the book:", struct.pack(">Bhh", 137, 300, 500).hex(" "))
print("radius of 500 mm:", robot.movement_controller.radius)
END
venv/bin/python drive.py >seen

cat >expected <<'END'
300 mm/s, 500 mm: 89 00 2c 01 f4 01
as the robot reads it: 44 mm/s, 500 mm and 01
by the book: 89 01 2c 01 f4
radius of 500 mm: -3071
END
diff expected seen || { echo "CHANGED: serialroomba-drive-padded" >&2; exit 1; }
echo "PASS: a drive command of five bytes is sent as six"
