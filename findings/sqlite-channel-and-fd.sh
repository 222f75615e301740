#!/bin/sh
# SPDX-License-Identifier: MIT
# A frame that python-can keeps in SQLite or CSV loses its channel, its direction and that it was CAN FD.
#
# Version:   python-can 4.6.1.
# Expected:  The database of python-can gives back the message that was stored.
# Behaviour: The tables have no such columns. A CAN FD frame of 64 bytes comes back as a classic one of 64 bytes,
#            which no bus has, and what was sent as received.
# Hurts:     Anyone who records two buses, or CAN FD, into a database: the frames can no longer be told apart or sent
#            again.
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

message = can.Message(
    timestamp=1.5, arbitration_id=0x123, is_extended_id=False, is_fd=True, bitrate_switch=True, is_rx=False,
    channel="can1", dlc=64, data=bytes(64),
)
for name in ("log.db", "log.csv"):
    with can.Logger(name) as writer:
        writer(message)
    for kept in can.LogReader(name):
        print(name, kept.dlc, kept.is_fd, kept.bitrate_switch, kept.is_rx, kept.channel)
END

cat >expected <<'END'
log.db 64 False False True None
log.csv 64 False False True None
END
diff expected seen || { echo "CHANGED: sqlite-channel-and-fd" >&2; exit 1; }
echo "PASS: 64 bytes come back as a classic frame that was received on no channel"
