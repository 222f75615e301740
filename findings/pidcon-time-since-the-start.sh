#!/bin/sh
# SPDX-License-Identifier: MIT
# The sum of pidcon grows with the square of the time, and its derivative is the error divided by the age of the
# controller.
#
# Version:   pidcon 0.1.0, Events 0.3.
# Expected:  A steady error of 1 and ki = 0.001 give an integral of 0.1 more at each period of 100 ms, and a derivative
#            of 0.
# Behaviour: The time of the last run is set by reset_pid() only, so the period of each run is the time since then: 100,
#            200, 300 ms. The derivative takes the error itself, not its change, divided by that time.
# Hurts:     Anyone who holds a speed or a distance by it: the older the controller, the harder it pushes, until the
#            limit. enable_pid() later than at the start begins with the whole time before.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pidcon==0.1.0 \
            Events==0.3 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >steady.py <<'END'
import threading
import time

clock = {"ns": 0}
time.monotonic_ns = lambda: clock["ns"]


class Never:
    """A timer that does not run: the test calls the controller itself."""

    def __init__(self, *args):
        pass

    def start(self):
        pass


threading.Timer = Never
from pidcon import PID

for gains in ({"ki": 0.001}, {"kd": 100.0}):
    clock["ns"] = 0
    seen = []
    controller = PID(0.1, **gains)
    controller.on_new_output += seen.append
    controller.enable_pid()
    controller.input_error = 1.0
    for _ in range(5):
        clock["ns"] += 100_000_000
        controller.calculate_output()
    print(f"{gains}, steady error of 1, every 100 ms:", [round(value, 3) for value in seen])
END
venv/bin/python steady.py >seen

cat >expected <<'END'
{'ki': 0.001}, steady error of 1, every 100 ms: [0.1, 0.3, 0.6, 1.0, 1.5]
{'kd': 100.0}, steady error of 1, every 100 ms: [1.0, 0.5, 0.333, 0.25, 0.2]
END
diff expected seen || { echo "CHANGED: pidcon-time-since-the-start" >&2; exit 1; }
echo "PASS: the integral is 0.1, 0.3, 0.6, 1.0 instead of 0.1, 0.2, 0.3, 0.4"
