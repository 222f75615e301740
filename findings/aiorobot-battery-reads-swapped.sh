#!/bin/sh
# SPDX-License-Identifier: MIT
# aiorobot reads what a Root robot measures in the byte order of the computer: a battery of 3700 mV is at 29710, and the
# cliff sensor is a mixture of its neighbours.
#
# Version:   aiorobot 0.3.0, crc8 0.2.1, on a machine with little-endian numbers.
# Expected:  Orders and events are packets of one protocol with the high byte first, so both are packed in one way.
# Behaviour: Orders are packed with the high byte first. Events are unpacked as a structure of the machine, with swapped
#            bytes and a byte of padding that no packet has. A single number comes out swapped, and of two numbers
#            behind a byte each is made of halves of two.
# Hurts:     Anyone who watches the battery, the light or the edge of a table by it. The bytes are right in the
#            notification, so struct with ">" before the format reads them.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            aiorobot==0.3.0 \
            crc8==0.2.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >events.py <<'END'
import struct
import sys
import types

sys.modules["bleak"] = types.ModuleType("bleak")  # Bluetooth is not needed here
from aiorobot import protocol
from aiorobot.events import Event


def seen(device, command, layout, *values):
    """Return the event of a packet as the robot sends it: head, numbers with the high byte first, filled up to 19."""
    packet = struct.pack(">3B" + layout, device, command, 0, *values)
    packet = packet.ljust(protocol.SIMPLE_PACKET_LEN, b"\0")
    packet += protocol.crc8(packet).digest()
    name, args, _ = protocol.extract_event(packet)
    return Event.parse(name, *args)


print("sent: 7 ms, 3700 mV, 80 per cent. read:", seen(14, 0, "IHB", 7, 3700, 80))
print("sent: 7 ms, cliff, 20 mV, threshold 300 mV. read:", seen(20, 0, "IBHH", 7, 1, 20, 300))
print("an order of 300 mm:", protocol.format_command("drive_distance", 300)[0][3:7].hex(" "))
END
venv/bin/python events.py >seen

cat >expected <<'END'
sent: 7 ms, 3700 mV, 80 per cent. read: BatteryEvent(timestamp=117440512, voltage=29710, percent=80)
sent: 7 ms, cliff, 20 mV, threshold 300 mV. read: CliffEvent(timestamp=117440512, cliff=Cliff.CLIFF, sensor=276, threshold=44)
an order of 300 mm: 00 00 01 2c
END
diff expected seen || { echo "CHANGED: aiorobot-battery-reads-swapped" >&2; exit 1; }
echo "PASS: 3700 mV are read as 29710"
