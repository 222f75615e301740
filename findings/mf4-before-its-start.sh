#!/bin/sh
# SPDX-License-Identifier: MIT
# A recording that python-can converts to MF4 lies years before the start of its own file.
#
# Version:   python-can 4.6.1, asammdf 8.8.28.
# Expected:  The start time of the measurement is that of its first frame, or earlier, and times since then are
#            positive.
# Behaviour: The start time is when the file was made. A frame of 2023 is at minus some ten million seconds.
#            python-can adds the two and is right; who shows times since the start is not.
# Hurts:     Anyone who opens a converted log in a tool that plots from zero on: the plot is empty, or the axis counts
#            backwards.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            python-can==4.6.1 asammdf==8.8.28 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
import time
import can
from asammdf import MDF

with can.MF4Writer("bus.mf4") as log:
    for seconds in (0, 1):
        log(can.Message(timestamp=1700000000.0 + seconds, arbitration_id=1, is_extended_id=False, data=b"\1", channel=0))
with MDF("bus.mf4") as mdf:
    print("starts when it was made:", abs(mdf.header.start_time.timestamp() - time.time()) < 600)
    times = mdf.get("CAN_DataFrame").timestamps
    print("times are negative:", bool((times < -60_000_000).all()), "apart:", f"{times[1] - times[0]:.3f}")
print([message.timestamp for message in can.MF4Reader("bus.mf4")])
END

cat >expected <<'END'
starts when it was made: True
times are negative: True apart: 1.000
[1700000000.0, 1700000001.0]
END
diff expected seen || { echo "CHANGED: mf4-before-its-start" >&2; exit 1; }
echo "PASS: frames of 2023 have negative times in a file that starts today"
