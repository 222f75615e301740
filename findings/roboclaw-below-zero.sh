#!/bin/sh
# SPDX-License-Identifier: MIT
# roboclaw reads an encoder at -1 as 4294967295, and so a motor in the middle of its range as at 214748415 per cent.
#
# Version:   roboclaw 1.0.0.dev1, PythonCRC 1.21, pyserial 3.5.
# Expected:  An encoder counts below zero: the controller's manual has a signed count, and read_range() of the same
#            library returns signed limits.
# Behaviour: The count is read unsigned, the limits signed. Just below zero the position jumps to two hundred million
#            per cent. The modes of the input pins S4 and S5 are both looked up by that of S3.
# Hurts:     Anyone who closes a loop over read_position(), or checks that an emergency stop is set up on S4.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            roboclaw==1.0.0.dev1 \
            PythonCRC==1.21 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >motor.py <<'END'
import os
import pty
import struct
import threading
import tty

from PyCRC.CRCCCITT import CRCCCITT
from roboclaw.roboclaw import RoboClaw
from roboclaw.roboclaw_cmd import Cmd

slave, master = pty.openpty()
tty.setraw(slave)
tty.setraw(master)
count = [0]


def answer(order):
    """Return what a controller answers: an encoder, its limits and gains, the modes of three pins."""
    if order == Cmd.GETM1ENC:
        return struct.pack(">iB", count[0], 0)
    if order == Cmd.READM1POSPID:
        return struct.pack(">IIIIIii", 0, 0, 0, 0, 0, -1000, 1000)
    return struct.pack(">BBB", 0, 2, 4)


def serve():
    while True:
        request = os.read(slave, 2)
        data = answer(request[1])
        os.write(slave, data + struct.pack(">H", CRCCCITT().calculate(request + data)))


threading.Thread(target=serve, daemon=True).start()
motor = RoboClaw(os.ttyname(master), 0x80)
for count[0] in (1, 0, -1):
    print(f"count {count[0]}: {motor.read_encoder(1)}, at {motor.read_position(1):.2f} % of -1000 to 1000")
print("pins that are 0, 2 (emergency stop), 4 (home):", motor.read_input_pin_modes())
END
venv/bin/python motor.py >seen

cat >expected <<'END'
count 1: 1, at 50.05 % of -1000 to 1000
count 0: 0, at 50.00 % of -1000 to 1000
count -1: 4294967295, at 214748414.75 % of -1000 to 1000
pins that are 0, 2 (emergency stop), 4 (home): ('Default', 'Disabled', 'Disabled')
END
diff expected seen || { echo "CHANGED: roboclaw-below-zero" >&2; exit 1; }
echo "PASS: an encoder at -1 is read as 4294967295"
