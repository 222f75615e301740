#!/bin/sh
# SPDX-License-Identifier: MIT
# The Madgwick filter of imusensor is NaN for good after one sample of a level sensor at rest, and ignores its gain; a
# robot that faces south faces north in the complementary one.
#
# Version:   imusensor 1.0.1, numpy 2.4.6.
# Expected:  A level sensor at rest keeps roll and pitch 0, and between the headings 179 and -179 degrees is 180.
# Behaviour: The correction is normalised: where it is exactly 0 it is divided by 0, and all that follows is NaN. With
#            any error it is a step of the same length, whose size comes from a constant; the argument b is not used.
#            The complementary filter averages headings as numbers.
# Hurts:     Anyone who tests with simulated samples, tunes the filter, or drives south.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            imusensor==1.0.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >level.py <<'END'
import warnings

import numpy as np
from imusensor.filters.complimentary import Complimentary
from imusensor.filters.madgwick import Madgwick

warnings.simplefilter("ignore")
level, turning = (0.0, 0.0, 9.75), (0.0, 0.0, 0.0)
still = Madgwick()
still.updateRollAndPitch(*level, *turning, 0.01)
print("level and at rest: roll", still.roll)
still.updateRollAndPitch(1.0, 2.0, 9.5, *turning, 0.01)
print("then tilted: roll", still.roll)
for gain in (0.001, 1.0):
    tilted = Madgwick(b=gain)
    tilted.updateRollAndPitch(1.0, 2.0, 9.5, *turning, 0.01)
    print(f"tilted, b {gain}: roll {tilted.roll:.3f} after the first sample")
south = Complimentary(gain=0.5)
south.setYaw(179.0)
south.updateRollPitchYaw(0.0, 0.0, -179.0, 0.0, 0.0, 0.0, 0.01)
print("between 179 and -179:", south.yaw)
END
venv/bin/python level.py >seen

cat >expected <<'END'
level and at rest: roll nan
then tilted: roll nan
tilted, b 0.001: roll 0.620 after the first sample
tilted, b 1.0: roll 0.620 after the first sample
between 179 and -179: 0.0
END
diff expected seen || { echo "CHANGED: imusensor-level-is-nan" >&2; exit 1; }
echo "PASS: one sample of a level sensor makes NaN of all later ones"
