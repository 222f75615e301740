#!/bin/sh
# SPDX-License-Identifier: MIT
# In ev3-python a wheel at -10 is at 4294967286, and a brick that does not answer has all sensors at 0.
#
# Version:   ev3-python 0.0.2, pyserial 3.5.
# Expected:  Encoders have signs, and a missing answer raises an error.
# Behaviour: The last four bytes of what was read within a second are taken as a number without a sign. No byte is 0,
#            and so an obstacle at 0 and a button that is not pressed. A brick that refuses the order sends five bytes:
#            the number is made of the counter and the status, and is a button that is pressed.
# Hurts:     Anyone who makes odometry of it, or stops before obstacles over Bluetooth.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            ev3-python==0.0.2 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >brick.py <<'END'
import struct

import serial

ANSWERS = {
    "encoder at 10": struct.pack("<HHBi", 7, 0, 2, 10),
    "encoder at -10": struct.pack("<HHBi", 7, 0, 2, -10),
    "no answer": b"",
    "order refused": struct.pack("<HHB", 3, 0, 4),
}


class Port:
    """A brick that answers each order by what is in answer."""

    def __init__(self, *arguments, **settings):
        pass

    def write(self, data):
        pass

    def read(self, size):
        return answer[:size]

    def close(self):
        pass


serial.Serial = Port

import ev3.ev3
from ev3.ev3 import Ev3

ev3.ev3.time.sleep = lambda seconds: None
brick = Ev3("/dev/rfcomm0")
for name, answer in ANSWERS.items():
    print(f"{name}: encoder {brick.encoder(Ev3.Encoders.A)}, ultrasonic {brick.ultrasonic(Ev3.Ports.P1)}, button {brick.button(Ev3.Ports.P2)}")
END
venv/bin/python brick.py >seen

cat >expected <<'END'
encoder at 10: encoder 10, ultrasonic 10, button False
encoder at -10: encoder 4294967286, ultrasonic 4294967286, button True
no answer: encoder 0, ultrasonic 0, button False
order refused: encoder 67108864, ultrasonic 67108864, button True
END
diff expected seen || { echo "CHANGED: ev3-python-silence-is-zero" >&2; exit 1; }
echo "PASS: -10 is 4294967286, and silence is an obstacle at 0"
