#!/bin/sh
# SPDX-License-Identifier: MIT
# The derivative of jataruku is a hundredth of its gain at ten samples a second, and depends on whether the period or
# the gains were set first.
#
# Version:   jataruku 0.1.1.
# Expected:  A value that falls by 1 a second gives an output of kd, at each period and in either order, as in the
#            library that this one is made from.
# Behaviour: set_tunings multiplies the derivative gain by the period, where it has to be divided by it; the property
#            sample_time divides. At 100 ms kd = 1 gives 0.01. Set to 50 ms before the gains it gives 0.0025, after
#            them 0.01.
# Hurts:     Anyone who takes over gains from a controller board, or halves the period of a loop.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            jataruku==0.1.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >gain.py <<'END'
import time

from jataruku import PID

clock = {"now": 1000.0}  # seconds, made by us
time.monotonic = lambda: clock["now"]


def derivative(period_ms, gains_first):
    """Return the output for kd = 1 and a value that falls by 1 a second."""
    outputs = []
    pid = PID(lambda: -clock["now"], outputs.append, 0.0, 0.0, 0.0, 1.0 if gains_first else 0.0, True)
    pid.sample_time = period_ms
    if not gains_first:
        pid.set_tunings(0.0, 0.0, 1.0)
    pid.auto = True
    for _ in range(3):
        clock["now"] += period_ms / 1000
        clock["now"] = round(clock["now"], 6) + 1e-9
        pid.compute()
    return outputs[-1]


for period_ms in (100, 50, 200):
    print(f"{period_ms} ms: {derivative(period_ms, True):.4f} with the gains first, {derivative(period_ms, False):.4f} with the period first")
END
venv/bin/python gain.py >seen

cat >expected <<'END'
100 ms: 0.0100 with the gains first, 0.0100 with the period first
50 ms: 0.0100 with the gains first, 0.0025 with the period first
200 ms: 0.0200 with the gains first, 0.0400 with the period first
END
diff expected seen || { echo "CHANGED: jataruku-derivative-is-a-hundredth" >&2; exit 1; }
echo "PASS: a derivative of 1 is 0.01"
