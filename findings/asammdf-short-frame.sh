#!/bin/sh
# SPDX-License-Identifier: MIT
# asammdf decodes signals that a short frame does not contain, as zero.
#
# Version:   asammdf 8.8.28, python-can 4.6.1 as the writer.
# Expected:  A frame of 2 bytes has no third byte, so the signal in it has no sample then, or an invalid one.
# Behaviour: The buffer of 64 bytes behind the frame is decoded whatever DataLength is. The missing health reads 0,
#            "healthy". cantools refuses the same frame.
# Hurts:     Anyone who monitors a node that cuts its frames when it starts or fails: it is reported as healthy.
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

cat >short.py <<'END'
from asammdf import MDF
from record import record

record((0, "10000200"), (0, "2000"))
with MDF("bus.mf4") as mdf:
    print("bytes", *mdf.get("CAN_DataFrame.DataLength").samples)
    with mdf.extract_bus_logging({"CAN": [("bus.dbc", 0)]}) as signals:
        for name in ("mm", "health"):
            signal = signals.get(name)
            print(name, *signal.samples, "all valid" if signal.invalidation_bits is None else "some invalid")
END
venv/bin/python short.py >seen

cat >expected <<'END'
bytes 4 2
mm 16 32 all valid
health b'disabled' b'healthy' all valid
END
diff expected seen || { echo "CHANGED: asammdf-short-frame" >&2; exit 1; }
echo "PASS: the state that a frame of 2 bytes lacks is read as healthy"
