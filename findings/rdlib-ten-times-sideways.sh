#!/bin/sh
# SPDX-License-Identifier: MIT
# In RdLib a target one metre ahead and one to the side is ten metres to the side: in metres x is divided by 100 and y
# by 1000.
#
# Version:   RdLib 0.9, numpy 1.26.4.
# Expected:  The radar sends millimetres, so in metres both coordinates are divided by 1000. The distance and the angle
#            are the same in all units.
# Behaviour: Only the unit of metres, which is the default, has two divisors. Distance and angle are computed of its
#            result: 1.41 m at 45 degrees become 10.05 m at 5.7 degrees.
# Hurts:     Anyone who tracks people with an RD-03D or LD2450 in the default unit: a target straight ahead is right,
#            all others are far off at the side.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            RdLib==0.9 \
            numpy==1.26.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >radar.py <<'END'
import sys
from unittest.mock import MagicMock

FRAME = bytes.fromhex("aaff0300" "e883" "e883" "0000" "6801" + "00" * 16 + "55cc")  # x 1000 mm, y 1000 mm


class Port:
    """A radar that reports one target."""

    in_waiting = len(FRAME)

    def __init__(self, *arguments, **options):
        pass

    def read(self, count):
        return FRAME

    def write(self, data):
        pass

    def flushInput(self):
        pass


sys.modules["serial"] = MagicMock(Serial=Port)
sys.modules.update({name: MagicMock() for name in ("matplotlib", "matplotlib.pyplot", "matplotlib.ticker")})

from RdLib import Rd
from RdLib.config import config

radar = Rd()
for unit in ("m", "cm", "mm"):
    config.set(distance_units=unit)
    x, y = radar.get_coordinate()
    print(f"{unit:2}: x {x:g}, y {y:g}, distance {radar.get_distance():.2f}, angle {radar.get_angle():.1f}")
END
venv/bin/python radar.py >seen

cat >expected <<'END'
m : x 10, y 1, distance 10.05, angle 5.7
cm: x 100, y 100, distance 141.42, angle 45.0
mm: x 1000, y 1000, distance 1414.21, angle 45.0
END
diff expected seen || { echo "CHANGED: rdlib-ten-times-sideways" >&2; exit 1; }
echo "PASS: 1 m aside is 10 m aside in metres, and 100 cm in centimetres"
