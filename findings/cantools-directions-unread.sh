#!/bin/sh
# SPDX-License-Identifier: MIT
# cantools decode passes over all lines of candump -x, and over nothing of candump -L -x.
#
# Version:   cantools 45.1.0.
# Expected:  -x adds the direction to both forms of candump, so both are decoded or none.
# Behaviour: In the log form the R at the end is accepted. In the screen form "RX - -" stands before the identifier:
#            each line is echoed without a decoding, and the exit code is 0.
# Hurts:     Anyone who switches on -x to see who sent a frame, and finds that the database "does not match".
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            cantools==45.1.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >bus.dbc <<'END'
VERSION ""
BU_: A
BO_ 291 Speed: 1 A
 SG_ mm : 0|8@1+ (10,0) [0|2550] "" A
END
cat >lines <<'END'
(1.0) can0 123#0A R
 (1.000000)  can0  123   [1]  0A
 (1.000000)  can0  RX - -  123   [1]  0A
END
venv/bin/cantools decode --single-line bus.dbc <lines >seen
echo "exit code $?" >>seen

cat >expected <<'END'
(1.0) can0 123#0A R :: Speed(mm: 100)
 (1.000000)  can0  123   [1]  0A
 (1.000000)  can0  RX - -  123   [1]  0A
exit code 0
END
diff expected seen || { echo "CHANGED: cantools-directions-unread" >&2; exit 1; }
echo "PASS: the screen form with directions is echoed undecoded"
