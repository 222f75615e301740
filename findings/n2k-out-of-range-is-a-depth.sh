#!/bin/sh
# SPDX-License-Identifier: MIT
# An echo sounder that reports its depth as out of range over NMEA 2000 is read by n2k as 42949672.94 m deep.
#
# Version:   n2k 0.5.0.
# Expected:  The number below the greatest one stands for out of range, as the greatest stands for not available, and
#            both are None; a value that cannot be sent raises.
# Behaviour: Only not available is None. Out of range is read as a number, though the package sends that very mark for
#            each value beyond its field: a greatest range of 3000 m is sent so and read as 2540 m, an offset of 40 m
#            as 32.766.
# Hurts:     Anyone who averages depths or compares them with a threshold where the bottom was lost.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            n2k==0.5.0 \
            python-can==4.6.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >depth.py <<'END'
import struct

from n2k.message import Message
from n2k.messages import WaterDepth, create_n2k_water_depth_message, parse_n2k_water_depth


def received(depth, offset, greatest):
    """Return what a message of PGN 128267 is read as."""
    message = Message()
    message.pgn = 128267
    message.data = bytearray(struct.pack("<BIhB", 1, depth, offset, greatest))
    message.data_len = 8
    seen = parse_n2k_water_depth(message)
    return seen.depth_below_transducer, seen.offset, seen.max_range


print("12.34 m, 0.5 m, 100 m:", received(1234, 500, 10))
print("not available:", received(0xFFFFFFFF, 0x7FFF, 0xFF))
print("out of range:", received(0xFFFFFFFE, 0x7FFE, 0xFE))
sent = create_n2k_water_depth_message(WaterDepth(depth_below_transducer=12.34, offset=40.0, max_range=3000))
seen = parse_n2k_water_depth(sent)
print("offset of 40 m and range of 3000 m, sent and read:", seen.offset, seen.max_range)
END
venv/bin/python depth.py >seen

cat >expected <<'END'
12.34 m, 0.5 m, 100 m: (12.34, 0.5, 100)
not available: (None, None, None)
out of range: (42949672.94, 32.766, 2540)
offset of 40 m and range of 3000 m, sent and read: 32.766 2540
END
diff expected seen || { echo "CHANGED: n2k-out-of-range-is-a-depth" >&2; exit 1; }
echo "PASS: out of range is read as 42949672.94 m"
