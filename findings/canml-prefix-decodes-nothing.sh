#!/bin/sh
# SPDX-License-Identifier: MIT
# canml with prefix_signals=True, its way out of equal names of signals, decodes no message at all.
#
# Version:   canml 0.1.14, cantools 39.4.4, python-can 4.4.0, pandas 2.2.2, numpy 1.26.4.
# Expected:  With the option each signal has the name of its message in front, and the same values.
# Behaviour: The names are changed after cantools has built its decoder, which still looks for the old ones. Each
#            message raises KeyError inside, is counted as dropped, and the table is empty with the right columns.
# Hurts:     Anyone who has Front in two messages, where the option is demanded by the error text. Decode file by file
#            without it, and rename the columns.
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

cat >prefix.py <<'END'
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
for i in range(3):
    for identifier in (256, 257):
        data = bytes([200, i, 0, 0, 0, 0, 0, 0])
        frame = can.Message(timestamp=1700000000 + i, arbitration_id=identifier, is_extended_id=False, data=data)
        writer.on_message_received(frame)
writer.stop()

logging.disable()
for prefix in (False, True):
    database = canml.load_dbc_files("robot.dbc", prefix_signals=prefix)
    table = canml.load_blf("robot.blf", database, canml.CanmlConfig(progress_bar=False))
    print(f"prefix_signals={prefix}: {len(table)} rows, columns {list(table.columns)}")
END
venv/bin/python prefix.py >seen

cat >expected <<'END'
prefix_signals=False: 6 rows, columns ['timestamp', 'Front', 'Speed']
prefix_signals=True: 0 rows, columns ['timestamp', 'Ring_Front', 'Drive_Speed']
END
diff expected seen || { echo "CHANGED: canml-prefix-decodes-nothing" >&2; exit 1; }
echo "PASS: of 6 messages 0 are decoded"
