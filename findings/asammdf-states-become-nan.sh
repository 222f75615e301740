#!/bin/sh
# SPDX-License-Identifier: MIT
# States that have names turn into NaN in asammdf as soon as one value without a name occurs.
#
# Version:   asammdf 8.8.28, python-can 4.6.1 as the writer.
# Expected:  The states 0 healthy, 1 suspect, 2 disabled of a DBC come out as texts or as numbers; a 7 is 7.
# Behaviour: If each value of the recording has a name, all are texts. If none has, all are numbers. If some have, the
#            nameless ones are numbers and each named state is NaN.
# Hurts:     Anyone who looks for faults in a log: one odd value, and the states that matter are gone.
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

cat >states.py <<'END'
from asammdf import MDF
from record import record

for states in ("00 01 02", "07 08 09", "00 01 02 07"):
    record(*((0, f"0000{state}00") for state in states.split()))
    with MDF("bus.mf4") as mdf, mdf.extract_bus_logging({"CAN": [("bus.dbc", 0)]}) as signals:
        print(states, "->", *signals.get("health").samples)
END
venv/bin/python states.py >seen

cat >expected <<'END'
00 01 02 -> b'healthy' b'suspect' b'disabled'
07 08 09 -> 7.0 8.0 9.0
00 01 02 07 -> nan nan nan 7.0
END
diff expected seen || { echo "CHANGED: asammdf-states-become-nan" >&2; exit 1; }
echo "PASS: the states 0, 1, 2 become NaN once a 7 is among them"
