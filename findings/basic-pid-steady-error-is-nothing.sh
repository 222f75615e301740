#!/bin/sh
# SPDX-License-Identifier: MIT
# basic-pid with a gain of 1 answers a steady error of 1 by 1 once and by 0 from then on: its default mode leaves out
# the sum, and its integral is no sum either.
#
# Version:   basic-pid 0.2.7.
# Expected:  A proportional controller answers a steady error by a steady output, and an integral grows.
# Behaviour: The three parts are those of the incremental form: the proportional one is the change of the error. In the
#            default mode, called iterate, they are the output; only setIntegrateModeOn() adds them up. The period of
#            setTimeinc is not used at all.
# Hurts:     Anyone who holds a speed or a distance by it: the robot lets go after one step.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            basic-pid==0.2.7 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >steady.py <<'END'
from basicpid import Pid

for name, gains, switch in (
    ("P, default mode", (1.0, 0.0, 0.0), None),
    ("P, integrate mode", (1.0, 0.0, 0.0), "setIntegrateModeOn"),
    ("I, default mode", (0.0, 1.0, 0.0), None),
):
    for period in (1.0, 0.1):
        pid = Pid()
        pid.setGains(*gains)
        pid.setTimeinc(period)
        if switch:
            getattr(pid, switch)()
        print(f"{name}, period {period}:", *(pid.get(1.0, 0.0) for step in range(4)))
END
venv/bin/python steady.py >seen

cat >expected <<'END'
P, default mode, period 1.0: 1.0 0.0 0.0 0.0
P, default mode, period 0.1: 1.0 0.0 0.0 0.0
P, integrate mode, period 1.0: 1.0 1.0 1.0 1.0
P, integrate mode, period 0.1: 1.0 1.0 1.0 1.0
I, default mode, period 1.0: 0.5 1.0 1.0 1.0
I, default mode, period 0.1: 0.5 1.0 1.0 1.0
END
diff expected seen || { echo "CHANGED: basic-pid-steady-error-is-nothing" >&2; exit 1; }
echo "PASS: a steady error of 1 is answered by 1, 0, 0 and 0"
