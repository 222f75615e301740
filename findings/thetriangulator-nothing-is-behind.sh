#!/bin/sh
# SPDX-License-Identifier: MIT
# With nothing in sight TheTriangulator reports a range of -171.5 m.
#
# Version:   TheTriangulator 0.1.0, ipywidgets 8.1.8, traitlets 5.14.3.
# Expected:  A range that is not there stays -1, the value that both ranges have before the first one.
# Behaviour: The wait for the echo ends after a second, and moves the start of the pulse along with it. The end of the
#            pulse stays where the trigger was, so the pulse lasts for minus one second.
# Hurts:     Anyone who compares the range with a limit, or averages it: a free way is nearer than every obstacle.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            TheTriangulator==0.1.0 \
            ipywidgets==8.1.8 \
            traitlets==5.14.3 \
            comm==0.2.3 \
            ipython==8.37.0 \
            decorator==5.3.1 \
            stack_data==0.6.3 \
            prompt_toolkit==3.0.53 \
            wcwidth==0.9.4 \
            matplotlib-inline==0.2.2 \
            Pygments==2.21.0 \
            jedi==0.20.1 \
            parso==0.8.7 \
            pexpect==4.9.0 \
            ptyprocess==0.7.0 \
            executing==2.3.0 \
            asttokens==3.0.2 \
            pure_eval==0.2.4 \
            typing_extensions==4.16.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >range.py <<'END'
import sys
import time
import types

clock = {"now": 5000.0, "rises": 0.0, "falls": 0.0}  # seconds, made by us


def advance(seconds):
    clock["now"] += seconds


def output(pin, high):
    """An HC-SR04: 0.45 ms after the trigger the echo pin rises, for as long as the echo takes."""
    if not high:
        clock["rises"] = clock["now"] + 0.00045
        clock["falls"] = clock["rises"] + metres * 2 / 343.0


def level(pin):
    advance(0.00001)
    return int(clock["rises"] <= clock["now"] < clock["falls"])


gpio = types.ModuleType("RPi.GPIO")
gpio.BCM = 11
gpio.output, gpio.input = output, level
sys.modules["RPi"] = types.ModuleType("RPi")
sys.modules["RPi"].GPIO = sys.modules["RPi.GPIO"] = gpio

from TheTriangulator import TriangulatorWorld

time.time, time.sleep = lambda: clock["now"], advance
for name, metres in (("a wall at 1 m", 1.0), ("nothing in sight", 0.0)):
    print(f"{name}: {TriangulatorWorld.distance(23, 20) / 100:.1f} m")
END
venv/bin/python range.py >seen

cat >expected <<'END'
a wall at 1 m: 1.0 m
nothing in sight: -171.5 m
END
diff expected seen || { echo "CHANGED: thetriangulator-nothing-is-behind" >&2; exit 1; }
echo "PASS: no echo is 171.5 m behind the sensor"
