#!/bin/sh
# SPDX-License-Identifier: MIT
# A remote request for 8 bytes asks for none after python-can wrote it to a candump log.
#
# Version:   python-can 4.6.1, log2asc of can-utils 2020.11.0 (Debian 12).
# Expected:  The length that a remote frame asks for is part of it: candump of can-utils writes R8, and python-can
#            reads it.
# Behaviour: The writer puts R for every length. python-can itself and log2asc then read a request for 0 bytes.
# Hurts:     Anyone who replays: a node that answers only to the right length stays silent.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            python-can==4.6.1 || return 1
    apt-get -qq -s install can-utils=2020.11.0-1 >plan &&
        sed -n 's/^Inst \([^ ]*\).*/\1/p' plan | xargs -r apt-get -qq download &&
        find . -name '*.deb' -exec dpkg -x {} debian \; || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }
PATH="$PWD/debian/usr/bin:$PWD/debian/usr/sbin:$PATH"
LD_LIBRARY_PATH="$PWD/debian/usr/lib/$(uname -m)-linux-gnu"
export PATH LD_LIBRARY_PATH

cat >write.py <<'END'
import can

with can.CanutilsLogWriter("bus.log") as log:
    log(can.Message(timestamp=1.0, arbitration_id=0x123, is_extended_id=False, is_remote_frame=True, dlc=8, channel=0))
with open("other.log", "w") as log:
    log.write("(1.000000) can0 123#R8\n")
for name in ("bus.log", "other.log"):
    print(name, *(message.dlc for message in can.CanutilsLogReader(name)))
END
venv/bin/python write.py >seen
cat bus.log >>seen
log2asc -I bus.log can0 | grep ' r ' >>seen

cat >expected <<'END'
bus.log 0
other.log 8
(1.000000) can0 123#R R
   0.000000 1  123             Rx   r 0
END
diff expected seen || { echo "CHANGED: canlog-remote-length" >&2; exit 1; }
echo "PASS: R8 is written as R and read as a request for 0 bytes"
