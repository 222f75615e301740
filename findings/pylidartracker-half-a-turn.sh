#!/bin/sh
# SPDX-License-Identifier: MIT
# pylidartracker loses half of the room of an HDL-32E that turns at 5 Hz: it drops what a frame has beyond 70000
# points, without a word.
#
# Version:   pylidartracker 1.0.5, dpkt 1.9.8, numpy 2.4.6.
# Expected:  A frame has all points of a turn, however slowly the scanner turns, and each turn of the capture is a
#            frame.
# Behaviour: The frame has room for 70000 points, enough at 10 Hz. At 5 Hz a turn has twice as many; the firings that
#            do not fit raise an error that is swallowed. All beyond 175 degrees is missing. The last turn of a capture
#            never comes out.
# Hurts:     Anyone who counts or tracks objects by a slow scanner: one side of the room is always empty.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            pylidartracker==1.0.5 \
            dpkt==1.9.8 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >turns.py <<'END'
import struct

import dpkt
from processing.pcapframeparser import PcapFrameParser


def capture(name, step, turns):
    """Write turns of a scanner that advances by so many hundredths of a degree from one firing to the next."""
    with open(name, "wb") as file:
        writer = dpkt.pcap.Writer(file)
        for first in range(0, turns * 36000 // step, 12):
            blocks = b"".join(
                struct.pack("<HH", 0xEEFF, (first + block) * step % 36000) + struct.pack("<HB", 1000, 9) * 32
                for block in range(12)
            )
            header = bytes(12) + b"\x08\x00" + b"\x45" + bytes(21) + struct.pack(">HH", 2368, 2368) + bytes(2)
            writer.writepkt(header.ljust(42, b"\0") + blocks + bytes(6), ts=first / 1000)


for hertz, step in ((10, 20), (5, 8)):
    capture("scan.pcap", step, 3)
    for number, (_, frame) in enumerate(PcapFrameParser("scan.pcap").generator(), 1):
        print(f"{hertz} Hz, frame {number} of 3: {36000 // step * 32} points measured, {len(frame.distance)} there, up to {max(frame.azimuth):.0f} degrees")
END
venv/bin/python turns.py >seen

cat >expected <<'END'
10 Hz, frame 1 of 3: 57600 points measured, 57600 there, up to 360 degrees
10 Hz, frame 2 of 3: 57600 points measured, 57600 there, up to 360 degrees
5 Hz, frame 1 of 3: 144000 points measured, 69984 there, up to 175 degrees
5 Hz, frame 2 of 3: 144000 points measured, 69984 there, up to 175 degrees
END
diff expected seen || { echo "CHANGED: pylidartracker-half-a-turn" >&2; exit 1; }
echo "PASS: of a turn at 5 Hz all beyond 175 degrees is missing"
