#!/bin/sh
# SPDX-License-Identifier: MIT
# ouster-os1 makes two frames of each turn, one of a single packet, and none at all where the first packet begins at
# encoder 0.
#
# Version:   ouster-os1 1.1.1.
# Expected:  frame_handler() puts one frame of all packets of a turn into the queue, wherever in the turn it starts to
#            listen.
# Behaviour: The encoder of an OS1 takes the same values in each turn. The first packet with the value it started at
#            ends a frame, and the next one ends another, of that packet alone. A start at 0 is taken for no start: the
#            packets pile up, and the queue stays empty.
# Hurts:     Anyone who takes a frame for a turn: rates are doubled, every other scan is a slice, and with bad luck at
#            the start there is none.
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

cat >frames.py <<'END'
import queue
import struct

from os1.packet import PACKET_SIZE
from os1.utils import frame_handler

TICKS = 90112
PACKETS = 32  # a turn of 512 columns, 16 in a packet


def packet(number):
    """Return packet number ``number``: time, columns and the encoder of its first column, the rest empty."""
    step = number % PACKETS
    start = struct.pack("<QHHI", number, step * 16, number // PACKETS, step * TICKS // PACKETS)
    return start.ljust(PACKET_SIZE, b"\0")


for first in (8, 1, 0):
    frames = queue.Queue()
    handler = frame_handler(frames)
    for number in range(first, first + 4 * PACKETS + 2):
        handler(packet(number))
    lengths = [len(frames.get()["buffer"]) for _ in range(frames.qsize())]
    print(f"four turns of {PACKETS} packets from packet {first} on: frames of {lengths} packets")
END
venv/bin/python frames.py >seen

cat >expected <<'END'
four turns of 32 packets from packet 8 on: frames of [1, 31, 1, 31, 1, 31, 1, 31, 1] packets
four turns of 32 packets from packet 1 on: frames of [1, 32, 32, 32, 32] packets
four turns of 32 packets from packet 0 on: frames of [] packets
END
diff expected seen || { echo "CHANGED: ouster-os1-frames-of-one-packet" >&2; exit 1; }
echo "PASS: a turn is a frame of one packet and one of the others"
