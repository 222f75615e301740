#!/bin/sh
# SPDX-License-Identifier: MIT
# Bluetin_Echo that looks at the echo pin too late reports the time since the machine was started as a range, and
# error code 0.
#
# Version:   Bluetin_Echo 0.2.0.
# Expected:  A pulse whose begin was missed gives no range, or at least an error code.
# Behaviour: The time of the rising edge is 0.0 until a low pin has been seen. If the pin is high already, the range is
#            the monotonic clock times 171.5 m/s. The pin rises half a millisecond after the trigger: one task that
#            runs in between is enough.
# Hurts:     Anyone who averages samples on a busy board: one such reading, of thousands of kilometres, counts as good.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            Bluetin_Echo==0.2.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >echo.py <<'END'
import sys
import time
import types

clock = {"now": 5000.0, "rises": 0.0, "falls": 0.0}  # a machine that was started 5000 s ago, its time made by us


def advance(seconds):
    clock["now"] += seconds


def output(pin, high):
    """An HC-SR04 with a wall at 1 m: 0.45 ms after the trigger the pin rises, for 5.83 ms."""
    if not high:
        clock["rises"] = clock["now"] + 0.00045
        clock["falls"] = clock["rises"] + 0.00583
        advance(late_s)


def level(pin):
    advance(0.00002)
    return int(clock["rises"] <= clock["now"] < clock["falls"])


gpio = types.ModuleType("RPi.GPIO")
gpio.BCM = gpio.OUT = gpio.IN = 0
gpio.setmode = gpio.setup = lambda *arguments: None
gpio.output, gpio.input = output, level
sys.modules["RPi"] = types.ModuleType("RPi")
sys.modules["RPi"].GPIO = sys.modules["RPi.GPIO"] = gpio
time.monotonic, time.sleep = lambda: clock["now"], advance

from Bluetin_Echo import Echo

for name, late_s in (("at once", 0.0), ("2 ms later", 0.002)):
    sonar = Echo(1, 2)
    advance(0.1)
    print(f"looks {name}: {sonar.read('m'):.1f} m, error code {sonar.error_code}")
END
venv/bin/python echo.py >seen

cat >expected <<'END'
looks at once: 1.0 m, error code 0
looks 2 ms later: 857708.6 m, error code 0
END
diff expected seen || { echo "CHANGED: bluetin-echo-reads-the-uptime" >&2; exit 1; }
echo "PASS: a look 2 ms late gives 857 km"
