#!/bin/sh
# SPDX-License-Identifier: MIT
# A pattern of scanpatterns that is rotated by a quarter turn is turned clockwise, and a circle visits its first point
# twice and knows no rate and no positions.
#
# Version:   scanpatterns 0.2.0, numpy 2.2.6.
# Expected:  rotation_rad of pi / 2 takes a point from x to y. A circle of eight points has eight, 45 degrees apart, and
#            a rate.
# Behaviour: The points are multiplied from the other side, so they go from x to -y. The end of the circle is its
#            beginning once more, so samples are 24 instead of 22.5 degrees apart. pattern_rate is 0 and positions is
#            empty, which only the raster fills.
# Hurts:     Anyone who turns a scan to fit a camera or a robot, or computes the time of a frame. Give the angle with a
#            minus.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            scanpatterns==0.2.0 \
            numpy==2.2.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >turn.py <<'END'
import math

import numpy as np
from scanpatterns import CircleScanPattern


def degrees(pattern):
    return np.round(np.degrees(np.arctan2(pattern.y, pattern.x)) % 360, 1)


plain = CircleScanPattern(8, 2.0, 1000)
turned = CircleScanPattern(8, 2.0, 1000, rotation_rad=math.pi / 2)
print("bearings of the first and last sample:", degrees(plain)[[0, -1]].tolist(), "of", len(plain.x))
print("steps:", np.unique(np.round(np.diff(degrees(plain)[:-1]), 1)).tolist(), "evenly they are", 360 / len(plain.x))
print("first bearing after a quarter turn:", degrees(turned)[0])
print("pattern_rate:", plain.pattern_rate, "sample_rate:", plain.sample_rate, "positions:", plain.positions.tolist())
END
venv/bin/python turn.py >seen

cat >expected <<'END'
bearings of the first and last sample: [0.0, 360.0] of 16
steps: [24.0] evenly they are 22.5
first bearing after a quarter turn: 270.0
pattern_rate: 0 sample_rate: 2000 positions: []
END
diff expected seen || { echo "CHANGED: scanpatterns-turns-clockwise" >&2; exit 1; }
echo "PASS: a quarter turn goes from x to -y"
