#!/bin/sh
# SPDX-License-Identifier: MIT
# A CAN FD frame of 64 bytes has 15 after python-can read it from TRC, and 16 once it went on to BLF.
#
# Version:   python-can 4.6.1.
# Expected:  The column L of TRC 2.1 is the code of the length: 15 means 64 bytes.
# Behaviour: The code is kept as the length. All 64 bytes are in the data, but len() is 15, the text shows 15, and the
#            BLF writer makes a frame of 16 of it. ASC and candump count the data and are right.
# Hurts:     Anyone who reads traces of PCAN with FD: each frame above 8 bytes is cut where len() or dlc is believed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            python-can==4.6.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
import can

DATA = bytes(range(64))
open("bus.trc", "w").write(
    ";$FILEVERSION=2.1\n;$STARTTIME=45244.9\n;$COLUMNS=N,O,T,B,I,d,R,L,D\n"
    f"      1         0.000 FB  1     0123 Rx -  15   {DATA.hex(' ').upper()}\n"
)
(message,) = can.TRCReader("bus.trc")
print("trc", len(message), len(message.data), message.data == DATA)
for name in ("bus.asc", "bus.log", "bus.blf"):
    with can.Logger(name) as log:
        log(message)
    (again,) = can.LogReader(name)
    print(name, len(again), len(again.data))
END

cat >expected <<'END'
trc 15 64 True
bus.asc 64 64
bus.log 64 64
bus.blf 16 64
END
diff expected seen || { echo "CHANGED: trc-fd-length" >&2; exit 1; }
echo "PASS: 64 bytes have the length 15 from TRC and 16 after BLF"
