#!/bin/sh
# SPDX-License-Identifier: MIT
# A frame that is older than the first one gets a time of 53 years in an ASC file of python-can.
#
# Version:   python-can 4.6.1.
# Expected:  A frame that arrives a millisecond late, as from a second adapter, is written at -0.001 s, or at the time
#            of the last one as the class states.
# Behaviour: Times are offsets from the first frame, but only those not before it are made so. An earlier one is
#            written as seconds since 1970. Read back as absolute times it lies in the year 2077.
# Hurts:     Anyone who merges two channels into one ASC file: one late frame stretches the log to 53 years.
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
import datetime
import can

with can.ASCWriter("bus.asc") as log:
    for time in (1700000000.0, 1700000000.002, 1699999999.999):
        log(can.Message(timestamp=time, arbitration_id=1, is_extended_id=False, data=b"\1", channel=0))
print(*(line.split()[0] for line in open("bus.asc") if " d " in line))
for message in can.ASCReader("bus.asc", relative_timestamp=False):
    print(message.timestamp, datetime.datetime.fromtimestamp(message.timestamp, datetime.timezone.utc).year)
END

cat >expected <<'END'
0.000000 0.002000 1699999999.999000
1700000000.0 2023
1700000000.002 2023
3399999999.999 2077
END
diff expected seen || { echo "CHANGED: asc-earlier-frame" >&2; exit 1; }
echo "PASS: a frame 1 ms before the first is written at 1699999999.999 s"
