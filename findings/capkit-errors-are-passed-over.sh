#!/bin/sh
# SPDX-License-Identifier: MIT
# capkit passes over every error frame of a candump log, where the same recording as ASC has them, and calls can0 and
# vcan0 one channel.
#
# Version:   capkit 0.3.0.
# Expected:  Frames have a field is_error_frame, so an error frame of a log sets it, whatever the format.
# Behaviour: In a candump log an error frame is dropped without a word; only strict=True tells, by an error that ends
#            the reading. Of the name of an interface the digits at its end are the channel, so can0, vcan0 and slcan0
#            are all 0, and can_left is none.
# Hurts:     Anyone who looks for faults of a bus, or records two of them: a log full of errors has none, and frames of
#            a test bus are taken for those of the robot. grep finds the errors in the log: their numbers begin with 2.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            capkit==0.3.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >errors.py <<'END'
import capkit

CANDUMP = """\
(1700000000.000000) can0 123#0102
(1700000000.100000) can0 20000080#0000000000000000
(1700000000.200000) vcan0 123#0304
(1700000000.300000) can_left 123#0506
"""
ASC = """\
date Tue Nov 14 22:13:20 2023
base hex  timestamps absolute
   0.000000 1  123             Rx   d 2 01 02
   0.100000 1  ErrorFrame
"""
open("bus.log", "w").write(CANDUMP)
open("bus.asc", "w").write(ASC)
for name in ("bus.log", "bus.asc"):
    for frame in capkit.read(name):
        what = "error" if frame.is_error_frame else frame.data.hex()
        print(f"{name}: channel {frame.channel}, {what}")
try:
    list(capkit.read("bus.log", strict=True))
except ValueError as error:
    print("strict: ValueError:", error)
END
venv/bin/python errors.py >seen

cat >expected <<'END'
bus.log: channel 0, 0102
bus.log: channel 0, 0304
bus.log: channel None, 0506
bus.asc: channel 1, 0102
bus.asc: channel 1, error
strict: ValueError: Unrecognized candump line 2: '(1700000000.100000) can0 20000080#0000000000000000'.
END
diff expected seen || { echo "CHANGED: capkit-errors-are-passed-over" >&2; exit 1; }
echo "PASS: an error frame of candump is not there"
