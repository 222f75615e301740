#!/bin/sh
# SPDX-License-Identifier: MIT
# Once one motor of l298n-driver was stopped none gets its enable pin back, and a speed of 255 is 182.
#
# Version:   l298n-driver 0.1.0.
# Expected:  forward() after stop() drives again, and getSpeed returns the speed that was set.
# Behaviour: Pin 15 of the expander is switched on when a motor is made, and off by each stop(), of any motor; nothing
#            switches it on again. stop() also leaves the speed pin at 255. Speeds are multiplied by 12 / 16.8, for one
#            particular battery.
# Hurts:     Anyone who stops before an obstacle and goes on, or drives two wheels by this board.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            l298n-driver==0.1.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >motor.py <<'END'
from l298n_driver.L298N import L298N


class Expander:
    """An SX1509 that keeps the state of its pins."""

    def __init__(self):
        self.pins = {}

    def pinMode(self, pin, mode):
        pass

    def digitalWrite(self, pin, value):
        self.pins[pin] = value

    analogWrite = digitalWrite


expander = Expander()
left, right = L298N(expander, 1, 2, 3), L298N(expander, 4, 5, 6)
left.set_speed(255)
print("speed 255 is", left.getSpeed())
for name, order in (("left goes", left.forward), ("right goes", right.forward), ("left stops", left.stop), ("left goes", left.forward)):
    order()
    print(f"{name}: enable pin {expander.pins[15]}, speed pin of the left one {expander.pins.get(3)}")
END
venv/bin/python motor.py >seen

cat >expected <<'END'
speed 255 is 182
left goes: enable pin 1, speed pin of the left one 182
right goes: enable pin 1, speed pin of the left one 182
left stops: enable pin 0, speed pin of the left one 255
left goes: enable pin 0, speed pin of the left one 0
END
diff expected seen || { echo "CHANGED: l298n-driver-never-starts-again" >&2; exit 1; }
echo "PASS: after stop() and forward() the enable pin is off"
