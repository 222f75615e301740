#!/bin/sh
# SPDX-License-Identifier: MIT
# A CAN FD frame without data is a remote frame after a round trip through ASC in python-can.
#
# Version:   python-can 4.6.1.
# Expected:  CAN FD has no remote frames, so a frame with the FD mark and no data stays what it was.
# Behaviour: The reader takes length zero for a remote request and returns FD and remote at once. BLF and candump keep
#            the frame.
# Hurts:     Anyone who counts heartbeats or wake-ups sent as empty FD frames, or replays them: nothing on an FD bus
#            answers.
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

for name in ("bus.asc", "bus.blf", "bus.log"):
    with can.Logger(name) as log:
        log(can.Message(timestamp=1.0, arbitration_id=1, is_extended_id=False, is_fd=True, channel=0))
    (message,) = can.LogReader(name)
    print(name, "fd" if message.is_fd else "classic", "remote" if message.is_remote_frame else "data")
END

cat >expected <<'END'
bus.asc fd remote
bus.blf fd data
bus.log fd data
END
diff expected seen || { echo "CHANGED: asc-empty-fd-frame" >&2; exit 1; }
echo "PASS: ASC returns the empty FD frame as a remote frame"
