#!/bin/sh
# SPDX-License-Identifier: MIT
# A TRC file of python-can counts the time before its first data frame twice.
#
# Version:   python-can 4.6.1.
# Expected:  A remote frame at T and a data frame at T + 10 s: TRC leaves out the first (with a warning), and the
#            second is at T + 10.
# Behaviour: Offsets count from the first frame of all, the start time of the header is that of the first one written.
#            The two are added when read: T + 20.
# Hurts:     Anyone who lays a TRC beside another recording: all frames are late by the wait for the first that TRC
#            can hold.
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
import logging
import can

logging.getLogger("can").setLevel(logging.ERROR)
with can.TRCWriter("bus.trc") as log:
    log(can.Message(timestamp=1700000000.0, arbitration_id=1, is_remote_frame=True, dlc=0))
    log(can.Message(timestamp=1700000010.0, arbitration_id=2, data=b"\1"))
for message in can.TRCReader("bus.trc"):
    print(message.timestamp - 1700000000.0)
END

cat >expected <<'END'
20.0
END
diff expected seen || { echo "CHANGED: trc-start-doubled" >&2; exit 1; }
echo "PASS: a frame 10 s after the start is read 20 s after it"
