#!/bin/sh
# SPDX-License-Identifier: MIT
# residual_resample of pfilter never draws a particle that weighs less than the mean, and filterpy's does the same.
#
# Version:   pfilter 0.2.5, filterpy 2.0.0, numpy 2.4.6.
# Expected:  Of four particles that weigh 0.4, 0.3, 0.2 and 0.1 there are 1.6, 1.2, 0.8 and 0.4 after resampling, on
#            average; systematic_resample gives that.
# Behaviour: What is left of each weight is taken from the weight, not from the weight times the number of particles,
#            so that it is negative for the heavy ones and they get all.
# Hurts:     Anyone whose robot must keep a second guess of where it is: it is gone after the first step.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            pfilter==0.2.5 \
            filterpy==2.0.0 \
            numpy==2.4.6 \
            scipy==1.17.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >light.py <<'END'
import numpy as np
from filterpy import monte_carlo
from pfilter import pfilter

np.random.seed(1)
weights = np.array([0.4, 0.3, 0.2, 0.1])
for name, draw in (
    ("pfilter systematic_resample", pfilter.systematic_resample),
    ("pfilter residual_resample", pfilter.residual_resample),
    ("filterpy residual_resample", monte_carlo.residual_resample),
):
    counts = sum(np.bincount(np.asarray(draw(weights.copy()), int), minlength=4) for _ in range(20000)) / 20000
    print(f"{name}: {[round(float(count), 1) for count in counts]} of {[float(w * 4) for w in weights]}")
END
venv/bin/python light.py >seen

cat >expected <<'END'
pfilter systematic_resample: [1.6, 1.2, 0.8, 0.4] of [1.6, 1.2, 0.8, 0.4]
pfilter residual_resample: [2.2, 1.8, 0.0, 0.0] of [1.6, 1.2, 0.8, 0.4]
filterpy residual_resample: [2.2, 1.8, 0.0, 0.0] of [1.6, 1.2, 0.8, 0.4]
END
diff expected seen || { echo "CHANGED: pfilter-light-particles-die" >&2; exit 1; }
echo "PASS: particles that weigh 0.2 and 0.1 are never drawn"
