#!/bin/sh
# SPDX-License-Identifier: MIT
# A second sensor in one program gets the beam angles of the first one in ouster-os1.
#
# Version:   ouster-os1 1.1.1.
# Expected:  The points of each OS1 are computed by the beam angles that this sensor reports when it is started.
# Behaviour: The table of angles belongs to the module and is filled once. start() of a second sensor, or of the same
#            one after it was exchanged, asks for its angles and drops them without a word.
# Hurts:     Anyone with two lasers, or one of 16 beams beside one of 64: the second cloud is bent, and calibration
#            blames the mount.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            ouster-os1==1.1.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >beams.py <<'END'
import struct

from os1.packet import PACKET
from os1.utils import build_trig_table, xyz_points

channel = [10000, 0, 0, 0, 0]  # 10 m
block = [0, 0, 0, 0] + channel * 64 + [0xFFFFFFFF]
packet = struct.pack(PACKET, *(block * 16))

for name, upper in (("first", 16.6), ("second", 33.2)):
    altitudes = [upper - 2 * upper * beam / 63 for beam in range(64)]
    build_trig_table(altitudes, [0.0] * 64)
    heights = xyz_points(packet)[2]
    print(f"{name} sensor, beams from {upper} to {-upper} degrees: heights at 10 m from {heights[0]:.2f} to {heights[63]:.2f} m")
END
venv/bin/python beams.py >seen

cat >expected <<'END'
first sensor, beams from 16.6 to -16.6 degrees: heights at 10 m from 2.86 to -2.86 m
second sensor, beams from 33.2 to -33.2 degrees: heights at 10 m from 2.86 to -2.86 m
END
diff expected seen || { echo "CHANGED: ouster-os1-beams-of-the-first" >&2; exit 1; }
echo "PASS: the second sensor has the beams of the first one"
