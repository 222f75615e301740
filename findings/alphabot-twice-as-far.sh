#!/bin/sh
# SPDX-License-Identifier: MIT
# After move(50, 0) of alphabot-interface the robot has driven 50 cm and believes to be at 100: the way is added twice.
#
# Version:   alphabot-interface 0.2.5.
# Expected:  The position after a move to a point is that point.
# Behaviour: move() calls move_distance(), which adds the way to the position, and adds it again. The next move starts
#            from a place where the robot is not, and goes back from there.
# Hurts:     Anyone who drives from point to point: a square comes out as a zigzag. set_position() after each move, with
#            the target, helps.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            alphabot-interface==0.2.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >move.py <<'END'
import contextlib
import io
import sys
import time
import types

gpio = types.ModuleType("RPi.GPIO")
gpio.BCM, gpio.OUT, gpio.HIGH, gpio.LOW = 11, 0, 1, 0
gpio.setmode = gpio.setwarnings = gpio.setup = gpio.output = lambda *args: None
gpio.PWM = lambda pin, rate: types.SimpleNamespace(start=lambda duty: None, ChangeDutyCycle=lambda duty: None)
sys.modules["RPi"] = types.ModuleType("RPi")
sys.modules["RPi"].GPIO = sys.modules["RPi.GPIO"] = gpio
time.sleep = lambda seconds: None
from alphabot import Motor

robot = Motor()
ways = []
inner = robot.move_distance
robot.move_distance = lambda distance, duration, angle: (ways.append((distance, angle)), inner(distance, duration, angle))
for target in ((50, 0), (50, 50), (0, 50)):
    with contextlib.redirect_stdout(io.StringIO()):
        robot.move(*target, 2)
    distance, angle = ways[-1]
    print(f"to {target}: drives {distance:.0f} cm after a turn by {angle:.0f} degrees, is at", end=" ")
    print(tuple(round(value) for value in robot.get_position()))
END
venv/bin/python move.py >seen

cat >expected <<'END'
to (50, 0): drives 50 cm after a turn by 0 degrees, is at (100, 0)
to (50, 50): drives 71 cm after a turn by 135 degrees, is at (0, 100)
to (0, 50): drives 50 cm after a turn by 135 degrees, is at (0, 0)
END
diff expected seen || { echo "CHANGED: alphabot-twice-as-far" >&2; exit 1; }
echo "PASS: a robot at 50 cm believes to be at 100"
