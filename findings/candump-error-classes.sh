#!/bin/sh
# SPDX-License-Identifier: MIT
# An error frame that candump recorded comes out of python-can as a data frame, unless it has one particular class.
#
# Version:   python-can 4.6.1.
# Expected:  A line of candump -L whose identifier has the error flag (20000000) is an error frame, whatever its
#            class.
# Behaviour: The reader also asks for the class 80 (bus error). A controller problem (04), a bus-off (40), a missing
#            acknowledge (20) becomes an ordinary frame with a 29-bit identifier equal to the class; a bus error loses
#            its data and channel.
# Hurts:     Anyone who searches a log for faults of the bus: no error shows, and traffic on identifiers 4, 20, 40
#            does that nobody sent.
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

with open("bus.log", "w") as log:
    for error in (0x04, 0x20, 0x40, 0x80):
        log.write(f"(1700000000.000000) can0 {0x20000000 | error:08X}#0004000000000000\n")
for message in can.CanutilsLogReader("bus.log"):
    print("error" if message.is_error_frame else "data", hex(message.arbitration_id), message.data.hex(), message.channel)
END

cat >expected <<'END'
data 0x4 0004000000000000 can0
data 0x20 0004000000000000 can0
data 0x40 0004000000000000 can0
error 0x0  None
END
diff expected seen || { echo "CHANGED: candump-error-classes" >&2; exit 1; }
echo "PASS: three of four error frames are read as data frames, the fourth without its data and channel"
