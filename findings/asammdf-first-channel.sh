#!/bin/sh
# SPDX-License-Identifier: MIT
# asammdf cannot select the first channel of a recording by python-can: its number means all.
#
# Version:   asammdf 8.8.28, python-can 4.6.1 as the writer.
# Expected:  A database for channel 0 decodes channel 0, one for channel 1 decodes channel 1.
# Behaviour: python-can stores its channel 0 as 0 (in ASC and BLF it adds one). For asammdf 0 is any bus. So the
#            database of the first bus is applied to the frames of all.
# Hurts:     Anyone who records two buses with different databases: the second one is decoded with the wrong one, too.
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

cat >bus.dbc <<'END'
VERSION ""
BU_: A
BO_ 291 Ring: 4 A
 SG_ mm : 0|16@1+ (1,0) [0|0] "" A
 SG_ health : 16|8@1+ (1,0) [0|0] "" A
VAL_ 291 health 0 "healthy" 1 "suspect" 2 "disabled" ;
END
cat >record.py <<'END'
import can


def record(*frames: tuple[int, str]) -> None:
    """Write a data frame 123 of each channel and data into bus.mf4."""
    with can.MF4Writer("bus.mf4") as log:
        for time, (channel, data) in enumerate(frames):
            message = can.Message(timestamp=1700000000.0 + time, arbitration_id=0x123, is_extended_id=False, channel=channel)
            message.data, message.dlc = bytearray.fromhex(data), len(data) // 2
            log(message)
END

cat >channels.py <<'END'
from asammdf import MDF
from record import record

record((0, "01000000"), (1, "02000000"))
for channel in (0, 1):
    with MDF("bus.mf4") as mdf, mdf.extract_bus_logging({"CAN": [("bus.dbc", channel)]}) as signals:
        ranges = [signal for signal in signals.iter_channels() if signal.name == "mm"]
        found = [(signal.source.name[:4], *map(int, signal.samples)) for signal in ranges]
        print("channel", channel, "->", *found)
END
venv/bin/python channels.py >seen

cat >expected <<'END'
channel 0 -> ('CAN0', 1) ('CAN1', 2)
channel 1 -> ('CAN1', 2)
END
diff expected seen || { echo "CHANGED: asammdf-first-channel" >&2; exit 1; }
echo "PASS: channel 0 selects the frames of channels 0 and 1"
