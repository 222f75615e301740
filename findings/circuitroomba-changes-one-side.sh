#!/bin/sh
# SPDX-License-Identifier: MIT
# circuitroomba changes the bit rate of the Roomba and not its own: all orders after baud() are lost.
#
# Version:   circuitroomba 0.1.0.
# Expected:  After baud(7) both sides run at 19200, and 0.1 s pass before the next order, as iRobot's Open Interface
#            demands; baud(0) sends the code 0.
# Behaviour: Only an attribute of the object becomes 19200, the port stays as it was, and the pause is a microsecond.
#            For code 0 no code is sent, so that the robot takes the next order for it.
# Hurts:     Anyone whose board cannot do 115200, whom this is for: the robot answers to nothing until it is switched
#            off.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            circuitroomba==0.1.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >baud.py <<'END'
import contextlib
import io
import sys
import time
import types


class Port:
    """A UART with a Roomba that understands what comes at its own bit rate."""

    def __init__(self, tx, rx, baudrate):
        self.baudrate, self.robot, self.sent = baudrate, 115200, []

    def write(self, data):
        self.sent.append(bytes(data) if self.baudrate == self.robot else b"(lost)")
        if len(self.sent) > 1 and self.sent[-2] == b"\x81":
            self.robot = {7: 19200}.get(data[0], "a rate that does not exist")


sys.modules["busio"] = types.SimpleNamespace(UART=Port)
sys.modules["digitalio"] = types.SimpleNamespace(Direction=types.SimpleNamespace(OUTPUT=1))
pauses = []
time.sleep = pauses.append

from circuitroomba.series6.roomba import Commands

for code in (7, 0):
    robot = Commands(1, 2, types.SimpleNamespace(direction=0, value=True))
    robot.start()
    pauses.clear()
    with contextlib.redirect_stdout(io.StringIO()):
        robot.baud(code)
    robot.safe()
    port = robot._board
    sent = [data.decode() if data == b"(lost)" else data.hex() for data in port.sent]
    print(f"baud({code}): sent {sent}, pause {sum(pauses) * 1000:.3f} ms; object {robot.baud_rate}, port {port.baudrate}, robot {port.robot}")
END
venv/bin/python baud.py >seen

cat >expected <<'END'
baud(7): sent ['80', '81', '07', '(lost)'], pause 0.001 ms; object 19200, port 115200, robot 19200
baud(0): sent ['80', '81', '83'], pause 0.001 ms; object 300, port 115200, robot a rate that does not exist
END
diff expected seen || { echo "CHANGED: circuitroomba-changes-one-side" >&2; exit 1; }
echo "PASS: after baud(7) the robot is at 19200 and the port at 115200"
