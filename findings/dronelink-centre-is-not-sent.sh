#!/bin/sh
# SPDX-License-Identifier: MIT
# center() of dronelink right after a move sends nothing and reports success, and its status says that the gimbal is
# at 0.
#
# Version:   dronelink 1.0.0.
# Expected:  An order that comes too soon after the last one is kept and sent later, or refused.
# Behaviour: An order within 20 ms of the last is dropped, and True is returned, as for one that was sent. The status
#            has the angles of the order. If no further order comes, the gimbal stays where it was: the last order of a
#            series is the one that is lost.
# Hurts:     Anyone who points a sensor by it and then stops sending.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            dronelink==1.0.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >centre.py <<'END'
from types import SimpleNamespace

import dronelink.gimbal
from dronelink import GimbalController

now = 100.0
dronelink.gimbal.time = SimpleNamespace(time=lambda: now)
sent = []
link = SimpleNamespace(CMD_GIMBAL_ANGLE=1, send_command=lambda _, data: not sent.append(int.from_bytes(data[:2], "little", signed=True) / 100))
gimbal = GimbalController(link, smooth_factor=1.0)
print("move to the right:", gimbal.set_angles(1.0, 0.0), "sent", sent)
now += 0.01
print("centre 10 ms later:", gimbal.center(), "sent", sent)
now += 10
print(f"10 s later: status {gimbal.get_status()['current_pan']:.0f} degrees, last order that was sent {sent[-1]:.0f}")
END
venv/bin/python centre.py >seen

cat >expected <<'END'
move to the right: True sent [90.0]
centre 10 ms later: True sent [90.0]
10 s later: status 0 degrees, last order that was sent 90
END
diff expected seen || { echo "CHANGED: dronelink-centre-is-not-sent" >&2; exit 1; }
echo "PASS: the order to centre returns True and is not sent"
