#!/bin/sh
# SPDX-License-Identifier: MIT
# A robot of delibot drives on when its program hangs: a thread repeats the last velocity, so the controller's limit
# of 0.5 s without orders is never reached.
#
# Version:   delibot 0.1.0, pyserial 3.5.
# Expected:  The velocity is sent when it is set. A program that hangs sends nothing, and the controller stops the
#            wheels after 0.5 s, which is what that limit is for.
# Behaviour: A thread in the background sends the last velocity every 0.1 s for as long as the process lives, whatever
#            the program does: while it waits for a sensor, sits at a breakpoint or has lost its loop to an error that
#            was caught.
# Hurts:     Anyone who counts on the timeout of the link as the last stop of a moving robot.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            delibot==0.1.0 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >hang.py <<'END'
import struct
import time

import delibot.controller


class Port:
    """A port that keeps what is written and never answers."""

    in_waiting = 0
    written = []

    def __init__(self, *_, **__):
        pass

    def read(self, _):
        time.sleep(0.05)
        return b""

    def write(self, data):
        self.written.append((time.monotonic(), data))

    def close(self):
        pass


delibot.controller.serial.Serial = Port
with delibot.controller.DelibotController("port") as robot:
    robot.set_velocity(300, 0)
    begin = time.monotonic()
    time.sleep(2)  # the program hangs
frames = [data for when, data in Port.written if when > begin + 0.6]
print("velocity orders from 0.6 s to 2 s after the only one:", "at least 5" if len(frames) >= 5 else len(frames))
print("in them:", sorted({struct.unpack("<hh", data[3:7]) for data in frames}), "mm/s and mrad/s")
END
venv/bin/python hang.py >seen

cat >expected <<'END'
velocity orders from 0.6 s to 2 s after the only one: at least 5
in them: [(300, 0)] mm/s and mrad/s
END
diff expected seen || { echo "CHANGED: delibot-drives-on" >&2; exit 1; }
echo "PASS: a program that hangs keeps the robot driving"
