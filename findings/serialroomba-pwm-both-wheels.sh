#!/bin/sh
# SPDX-License-Identifier: MIT
# Setting the power of the left wheel in serialroomba sets that of the right wheel too.
#
# Version:   serialroomba 0.1.2.
# Expected:  pwm_left_wheel and pwm_right_wheel are set one after the other, and each is what was set.
# Behaviour: pwm_right_wheel returns the left value, so the command for the left wheel carries it twice. Right alone
#            cannot be read back: it is still what the left one is.
# Hurts:     Anyone who turns on the spot by the two: it jerks forward first.
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

cat >pwm.py <<'END'
import serial


class Port:
    """A serial port that notes what is written to it."""

    def __init__(self, *args, **kwargs):
        self.sent, self.is_open = b"", False

    def open(self):
        self.is_open = True

    def write(self, data):
        self.sent += data


serial.Serial = Port
from serialroomba.serialroomba import SerialRoomba

robot = SerialRoomba("roomba")
wheels = robot.movement_controller


def powers():
    """Return the two values of the last command; its byte order is no matter here."""
    sent = robot.serial_controller.connection.sent[-4:]
    return tuple(value - 256 if value > 127 else value for value in (sent[0], sent[2]))


wheels.pwm_left_wheel = 100
print("left set to 100: sent right %d, left %d; read right %d, left %d" % (*powers(), wheels.pwm_right_wheel, wheels.pwm_left_wheel))
wheels.pwm_right_wheel = -100
print("right set to -100: sent right %d, left %d; read right %d, left %d" % (*powers(), wheels.pwm_right_wheel, wheels.pwm_left_wheel))
wheels.pwm_left_wheel = 90
print("left set to 90: sent right %d, left %d; read right %d, left %d" % (*powers(), wheels.pwm_right_wheel, wheels.pwm_left_wheel))
END
venv/bin/python pwm.py >seen

cat >expected <<'END'
left set to 100: sent right 100, left 100; read right 100, left 100
right set to -100: sent right -100, left 100; read right 100, left 100
left set to 90: sent right 90, left 90; read right 90, left 90
END
diff expected seen || { echo "CHANGED: serialroomba-pwm-both-wheels" >&2; exit 1; }
echo "PASS: left set to 100 sends 100 for both wheels"
