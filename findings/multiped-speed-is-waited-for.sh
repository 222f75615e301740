#!/bin/sh
# SPDX-License-Identifier: MIT
# multiped drives all servos at four fixed speeds, and only waits by the speed that was asked for.
#
# Version:   multiped 0.5.1, pyservos 1.0.2, pyserial 3.5.
# Expected:  A step with the speed 50 is sent with the speed 50, and one with 500 with 500.
# Behaviour: Each packet has the speeds 100, 125, 150 and 200 for the four joints of a leg. The time until the next step
#            is computed from the speed that was asked for, so at 500 the next step is sent long before a servo has
#            arrived.
# Hurts:     Anyone who walks slowly on purpose, or fast: at 50 the robot jerks and waits, at 500 its legs never reach a
#            foothold. Ask for 100, the slowest of the four.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            multiped==0.5.1 \
            pyservos==1.0.2 \
            pyserial==3.5 \
            simplejson==3.20.2 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >speed.py <<'END'
import contextlib
import io
import time

from multiped import Engine as module
from multiped.Engine import Engine
from pyservos import AX12

waits = []
time.sleep = waits.append
sent = []
with contextlib.redirect_stdout(io.StringIO()):
    robot = Engine({name: [50.0, 150.0] for name in ("coxa", "femur", "tibia", "tarsus")}, AX12)
robot.serial.write = sent.append
for speed in (50, 500):
    before = [0.0, 130.26, -115.73, -104.52]
    robot.last_move = {leg: list(before) for leg in range(4)}
    sent.clear()
    waits.clear()
    with contextlib.redirect_stdout(io.StringIO()):
        robot.moveLegsGait4({0: [(30.0, 130.0, -115.0, -104.0, speed)]})
    packet = list(sent[0])
    start = next(i for i in range(len(packet)) if packet[i : i + 2] == [30, 4]) + 2  # address and length of a record
    records = [packet[i : i + 5] for i in range(start, start + 20, 5)]
    print(f"asked for {speed}: sent {[low + 256 * high for _, _, _, low, high in records]}, waits {waits[-1]:.2f} s")
arrive = 30 / (0.111 * 100 * 6)
print(f"the first joint needs {arrive:.2f} s at 100")
END
venv/bin/python speed.py >seen

cat >expected <<'END'
asked for 50: sent [100, 125, 150, 200], waits 0.90 s
asked for 500: sent [100, 125, 150, 200], waits 0.09 s
the first joint needs 0.45 s at 100
END
diff expected seen || { echo "CHANGED: multiped-speed-is-waited-for" >&2; exit 1; }
echo "PASS: speeds of 50 and 500 are sent as 100, 125, 150 and 200"
