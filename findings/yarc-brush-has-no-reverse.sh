#!/bin/sh
# SPDX-License-Identifier: MIT
# yarc cannot run a brush backwards: motors_pwm promises -127 to 127 and raises below 0.
#
# Version:   yarc 0.9.3.
# Expected:  motors_pwm(main_brush=-55) sends -55, as its text has it and its clamp allows.
# Behaviour: It holds the value against -127 and packs it without a sign: struct.error.
# Hurts:     Anyone who frees a tangled brush.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            yarc==0.9.3 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >brush.py <<'END'
from yarc import Roomba


class Port:
    """A serial port that notes what is written to it."""

    baudrate, is_open = 115200, False

    def write(self, data):
        self.sent = data


robot = Roomba.__new__(Roomba)
robot.serial = Port()
for value in (55, 300, -55, -300):
    try:
        robot.motors_pwm(main_brush=value)
        print(f"main_brush={value}: sent {robot.serial.sent.hex(' ')}")
    except Exception as error:
        print(f"main_brush={value}: {type(error).__name__}: {error}")
robot.motors(main_brush=True, main_brush_outward=True)
print("motors(main_brush=True, main_brush_outward=True): sent", robot.serial.sent.hex(" "))
END
venv/bin/python brush.py >seen

cat >expected <<'END'
main_brush=55: sent 90 37 00 00
main_brush=300: sent 90 7f 00 00
main_brush=-55: error: ubyte format requires 0 <= number <= 255
main_brush=-300: error: ubyte format requires 0 <= number <= 255
motors(main_brush=True, main_brush_outward=True): sent 8a 14
END
diff expected seen || { echo "CHANGED: yarc-brush-has-no-reverse" >&2; exit 1; }
echo "PASS: motors_pwm(-55) raises struct.error"
