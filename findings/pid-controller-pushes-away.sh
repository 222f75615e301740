#!/bin/sh
# SPDX-License-Identifier: MIT
# pid-controller pushes away from its target: with a gain of 1 and a target of 10 it answers 4 by -6, and its integral
# has no memory.
#
# Version:   pid-controller 0.2.0, six 1.17.0.
# Expected:  A positive gain answers a value below the target by a positive output, and a steady error is summed up.
# Behaviour: Each part is subtracted, so all outputs have the other sign. The integral is the error times the last
#            period, and the same at each call. The first call has a derivative from 0 to the value.
# Hurts:     Anyone who swaps controllers: the robot runs from its set point, at full speed. Gains below zero turn it
#            around, a sum has to be kept outside.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pid-controller==0.2.0 \
            six==1.17.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >target.py <<'END'
from pid_controller.pid import PID

clock = {"now": 0.0}
for gains in ({"p": 1}, {"i": 1}, {"d": 1}):
    clock["now"] = 0.0
    controller = PID(**gains, get_time=lambda: clock["now"])
    controller.target = 10
    seen = []
    for feedback in (4, 4, 4, 6):
        clock["now"] += 1.0
        seen.append(controller(feedback))
    print(f"{gains}, target 10, values 4, 4, 4, 6:", seen)
END
venv/bin/python target.py >seen

cat >expected <<'END'
{'p': 1}, target 10, values 4, 4, 4, 6: [-6.0, -6.0, -6.0, -4.0]
{'i': 1}, target 10, values 4, 4, 4, 6: [-6.0, -6.0, -6.0, -4.0]
{'d': 1}, target 10, values 4, 4, 4, 6: [-4.0, 0.0, 0.0, -2.0]
END
diff expected seen || { echo "CHANGED: pid-controller-pushes-away" >&2; exit 1; }
echo "PASS: a value below the target is answered by -6"
