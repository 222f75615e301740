#!/bin/sh
# SPDX-License-Identifier: MIT
# canml asked for no identifiers warns that no messages will be decoded and decodes all, and its interpolate_missing
# leaves every gap.
#
# Version:   canml 0.1.14, cantools 39.4.4, python-can 4.4.0, pandas 2.2.2, numpy 1.26.4.
# Expected:  An empty set of identifiers gives an empty table, as the warning says. interpolate_missing fills the rows
#            in which a signal was not sent.
# Behaviour: An empty set counts as no filter. Only signals that never came are interpolated, from nothing, so they stay
#            NaN as the gaps do.
# Hurts:     Anyone who computes the set of identifiers, or joins ranges of one message with speeds of another. Test the
#            set, and call interpolate() on the table.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            canml==0.1.14 \
            cantools==39.4.4 \
            python-can==4.4.0 \
            pandas==2.2.2 \
            numpy==1.26.4 \
            pyarrow==26.0.1 \
            tqdm==4.70.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >none.py <<'END'
import logging

import can
import canml

DATABASE = """\
VERSION ""
NS_ :
BS_:
BU_: A
BO_ 256 Ring: 8 A
 SG_ Front : 0|16@1+ (0.01,0) [0|100] "m" A
BO_ 257 Drive: 8 A
 SG_ Speed : 0|16@1+ (0.001,0) [0|10] "m/s" A
"""
open("robot.dbc", "w").write(DATABASE)
writer = can.BLFWriter("robot.blf")
for i in range(2):
    for identifier in (256, 257):
        data = bytes([200, i, 0, 0, 0, 0, 0, 0])
        frame = can.Message(timestamp=1700000000 + i, arbitration_id=identifier, is_extended_id=False, data=data)
        writer.on_message_received(frame)
writer.stop()

told = []
logger = logging.getLogger("canml.canmlio")
logger.handlers.clear()
logger.addFilter(lambda record: told.append(record.getMessage()) or False)
for name, ids in (("all", None), ("0x100", {0x100}), ("none", set())):
    told.clear()
    table = canml.load_blf("robot.blf", "robot.dbc", canml.CanmlConfig(progress_bar=False), message_ids=ids)
    print(f"{name}: {len(table)} rows;", told[0])
filled = canml.load_blf("robot.blf", "robot.dbc", canml.CanmlConfig(progress_bar=False, interpolate_missing=True))
print("Front, interpolated:", [round(float(value), 2) for value in filled["Front"]])
END
venv/bin/python none.py >seen

cat >expected <<'END'
all: 4 rows; Decoded 4/4 messages (0 dropped)
0x100: 2 rows; Decoded 2/4 messages (2 dropped)
none: 4 rows; Empty message_ids provided; no messages will be decoded
Front, interpolated: [2.0, nan, 4.56, nan]
END
diff expected seen || { echo "CHANGED: canml-no-ids-are-all" >&2; exit 1; }
echo "PASS: no identifiers give all messages"
