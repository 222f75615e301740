#!/bin/sh
# SPDX-License-Identifier: MIT
# An ASC file of python-can that starts 5 ms after the second is read by python-can as starting 500 ms after it.
#
# Version:   python-can 4.6.1.
# Expected:  The start of the measurement has three decimals, so .005 is written as .005.
# Behaviour: The milliseconds are written without leading zeros, as .5, and read as a decimal fraction, as half a
#            second. Every recording that starts in the first 100 ms of a second is off by up to 0.9 s, one in ten.
# Hurts:     Anyone who lines up an ASC file with a bag or a video: nine times of ten it fits.
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

for start in (1700000000.5, 1700000000.005, 1700000000.098):
    with can.ASCWriter("bus.asc") as log:
        log(can.Message(timestamp=start, arbitration_id=1, is_extended_id=False, data=b"\1", channel=0))
    (message,) = can.ASCReader("bus.asc", relative_timestamp=False)
    print([line.strip() for line in open("bus.asc") if line.startswith("Begin")][0], f"{message.timestamp - start:+.3f} s")
END

cat >expected <<'END'
Begin Triggerblock Tue Nov 14 22:13:20.500 2023 +0.000 s
Begin Triggerblock Tue Nov 14 22:13:20.5 2023 +0.495 s
Begin Triggerblock Tue Nov 14 22:13:20.98 2023 +0.882 s
END
diff expected seen || { echo "CHANGED: asc-milliseconds-unpadded" >&2; exit 1; }
echo "PASS: a start at .005 s is read 495 ms late, one at .098 s 882 ms late"
