#!/bin/sh
# SPDX-License-Identifier: MIT
# The candump writer of python-can turns every error frame into a bus error without a cause.
#
# Version:   python-can 4.6.1.
# Expected:  The class of an error (here 04, controller problem, receive queue overflow) is in the file again.
# Behaviour: It writes the identifier 20000080 for each error frame, beside the data of the original class. What it
#            wrote itself it reads without data. BLF and CSV keep both.
# Hurts:     Anyone who converts BLF to candump: an overflow of a buffer is reported as a fault of the wire.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            python-can==4.6.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
import can

overflow = can.Message(
    timestamp=1.0, arbitration_id=0x04, is_extended_id=False, is_error_frame=True, data=bytes([0, 1, 0, 0, 0, 0, 0, 0]), channel=0
)
for name in ("bus.log", "bus.blf", "bus.csv"):
    with can.Logger(name) as log:
        log(overflow)
    (message,) = can.LogReader(name)
    print(name, hex(message.arbitration_id), message.data.hex() or "no data")
print(open("bus.log").read().strip())
END

cat >expected <<'END'
bus.log 0x0 no data
bus.blf 0x4 0001000000000000
bus.csv 0x4 0001000000000000
(1.000000) can0 20000080#0001000000000000
END
diff expected seen || { echo "CHANGED: canlog-one-error" >&2; exit 1; }
echo "PASS: class 04 is written as class 80, which BLF and CSV do not do"
