#!/bin/sh
# SPDX-License-Identifier: MIT
# A frame older than the first one is moved by python-can in BLF and in candump, not in CSV: three formats, three
# times.
#
# Version:   python-can 4.6.1.
# Expected:  A frame 1.5 s before the first (a second adapter, a sorted merge undone) has one time, whatever the
#            format.
# Behaviour: BLF puts it at the start of the file, which is cut to milliseconds and so may lie before the first frame.
#            candump puts it at the first frame. CSV keeps it.
# Hurts:     Anyone who compares two conversions of one recording: they differ by seconds in some frames only.
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

for name in ("bus.blf", "bus.log", "bus.csv"):
    with can.Logger(name) as log:
        for time in (1700000000.123456, 1699999998.623456):
            log(can.Message(timestamp=time, arbitration_id=1, is_extended_id=False, data=b"\1", channel=0))
    first, second = can.LogReader(name)
    print(name, f"{second.timestamp - first.timestamp:.6f}")
END

cat >expected <<'END'
bus.blf -0.000456
bus.log 0.000000
bus.csv -1.500000
END
diff expected seen || { echo "CHANGED: blf-earlier-frame" >&2; exit 1; }
echo "PASS: 1.5 s before the first frame is -0.000456 s in BLF, 0 in candump, -1.5 in CSV"
