#!/bin/sh
# SPDX-License-Identifier: MIT
# waitFor(900) of one-easy-protocol does not wait, and waitFor(1900) waits one second.
#
# Version:   one-easy-protocol 0.4, pyserial 3.5.
# Expected:  The number of milliseconds that is given is waited for.
# Behaviour: The time is divided by 1000 and cut to whole seconds: 900 ms are none.
# Hurts:     Anyone who waits for a gripper to close or a sensor to settle.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            one-easy-protocol==0.4 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >wait.py <<'END'
import time

from easyprotocol.easyprotocol import Functions

slept = []
time.sleep = slept.append
for milliseconds in (100, 900, 1000, 1900):
    Functions(object(), "A", "1").waitFor(milliseconds)
    print(f"waitFor({milliseconds}): {slept.pop()} s")
END
venv/bin/python wait.py >seen

cat >expected <<'END'
waitFor(100): 0 s
waitFor(900): 0 s
waitFor(1000): 1 s
waitFor(1900): 1 s
END
diff expected seen || { echo "CHANGED: one-easy-protocol-waits-whole-seconds" >&2; exit 1; }
echo "PASS: 900 ms are not waited for"
