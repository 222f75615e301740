#!/bin/sh
# SPDX-License-Identifier: MIT
# A Roomba that does not answer stands at 0 mV and 0 mm for pyroombaadapter, and a late answer is half of the next
# value.
#
# Version:   pyroombaadapter 0.3.0.
# Expected:  A reading without an answer raises or is None, and an answer that comes too late is dropped.
# Behaviour: What was received until the time-out, be it nothing or one byte of two, is taken for the number. The bytes
#            that come later are taken for the next reading, and all after it are shifted.
# Hurts:     Anyone who sums up distances, or stops at a low voltage: a sleeping robot is empty and stands still.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pyroombaadapter==0.3.0 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >silence.py <<'END'
import contextlib
import io

import serial


class Port:
    """A serial port with a Roomba behind it; a time-out of it returns what is there."""

    def __init__(self, *args, **kwargs):
        self.answers, self.there = [], b""

    def isOpen(self):
        return True

    def write(self, data):
        if data[0] == 142 and self.answers:
            self.there += self.answers.pop(0)

    def read(self, size):
        data, self.there = self.there[:size], self.there[size:]
        return data

    def close(self):
        pass


serial.Serial = Port
from pyroombaadapter import PyRoombaAdapter

with contextlib.redirect_stdout(io.StringIO()):
    robot = PyRoombaAdapter("roomba")
print("asleep:", robot.request_voltage(), "mV,", robot.request_distance(), "mm, mode", robot.request_oi_mode())
port = robot.serial_con
port.answers = [(14800).to_bytes(2, "big"), (120).to_bytes(2, "big"), (120).to_bytes(2, "big")]
print("awake:", robot.request_voltage(), "mV,", robot.request_distance(), "mm,", robot.request_distance(), "mm")
voltage = (14800).to_bytes(2, "big")
port.answers = [voltage[:1], voltage[1:] + (120).to_bytes(2, "big"), (120).to_bytes(2, "big")]
print("one byte late:", robot.request_voltage(), "mV,", robot.request_distance(), "mm,", robot.request_distance(), "mm")
END
venv/bin/python silence.py >seen

cat >expected <<'END'
asleep: 0 mV, 0 mm, mode 0
awake: 14800 mV, 120 mm, 120 mm
one byte late: 57 mV, -12288 mm, 30720 mm
END
diff expected seen || { echo "CHANGED: pyroombaadapter-silence-is-zero" >&2; exit 1; }
echo "PASS: silence is read as 0 mV and 0 mm, and one late byte shifts all that follows"
