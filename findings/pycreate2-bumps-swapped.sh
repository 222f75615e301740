#!/bin/sh
# SPDX-License-Identifier: MIT
# pycreate2 reports a bump on the left as one on the right, and a left wheel that hangs in the air as the right one.
#
# Version:   pycreate2 0.8.0.
# Expected:  Bit 1 of the first sensor byte is the left bumper and bit 3 the left wheel, in iRobot's Open Interface and
#            in the constants of this package; bump_left shows the first.
# Behaviour: The record has the left sides first and is filled with the right ones first. The six light bumpers beside
#            it are right.
# Hurts:     Anyone whose Create 2 or Roomba backs off and turns away from what it touched: it turns into it, or over
#            the edge.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pycreate2==0.8.0 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >bumps.py <<'END'
from pycreate2.OI import BUMPS_WHEEL_DROPS
from pycreate2.packets import SensorPacketDecoder

for name in ("BUMP_LEFT", "BUMP_RIGHT", "WHEEL_DROP_LEFT", "WHEEL_DROP_RIGHT"):
    packet = bytes([getattr(BUMPS_WHEEL_DROPS, name)]) + bytes(79)
    seen = SensorPacketDecoder(packet).bumps_wheeldrops._asdict()
    print(f"{name}: {', '.join(key for key, on in seen.items() if on)}")
light = SensorPacketDecoder(bytes(56) + b"\x01" + bytes(23)).light_bumper._asdict()
print(f"light bumper LEFT: {', '.join(key for key, on in light.items() if on)}")
END
venv/bin/python bumps.py >seen

cat >expected <<'END'
BUMP_LEFT: bump_right
BUMP_RIGHT: bump_left
WHEEL_DROP_LEFT: wheeldrop_right
WHEEL_DROP_RIGHT: wheeldrop_left
light bumper LEFT: left
END
diff expected seen || { echo "CHANGED: pycreate2-bumps-swapped" >&2; exit 1; }
echo "PASS: a bump on the left is bump_right"
