#!/bin/sh
# SPDX-License-Identifier: MIT
# North is along x for madgwick_update of qsp-orientation and along y for mahony_update, so the two are 90 degrees
# apart.
#
# Version:   qsp-orientation 0.1.1, numpy 2.4.6.
# Expected:  Two filters of one package, with the same arguments in the same order, agree on the attitude. A
#            magnetometer that reads the opposite of the reference is not consistent with it.
# Behaviour: A level robot whose magnetometer sees north straight ahead has a heading of 0 for one filter and of 90 for
#            the other. mag_consistency_metric is 1, documented as perfect, for the opposite field: it takes the size of
#            the cosine, so a sensor that is mounted the wrong way round, or swapped in sign, has full marks in
#            orientation_health_score.
# Hurts:     Anyone who swaps one filter for the other, or watches the magnetometer by the metric.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            qsp-orientation==0.1.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >north.py <<'END'
import math

import numpy as np
from qsp.orientation import madgwick_update, mag_consistency_metric, mahony_update, orientation_health_score, quaternion_to_euler

REST, GRAVITY = [0.0, 0.0, 0.0], [0.0, 0.0, 9.81]


def heading(attitude) -> int:
    """Return the heading of ATTITUDE in whole degrees."""
    return round(math.degrees(quaternion_to_euler(attitude)[2]))


for name, field in (("ahead", [1.0, 0.0, 0.0]), ("to the left", [0.0, 1.0, 0.0])):
    first = second = np.array([1.0, 0.0, 0.0, 0.0])
    error = None
    for _ in range(5000):
        first = madgwick_update(first, REST, GRAVITY, dt=0.01, mag=field)
        second, error = mahony_update(second, REST, GRAVITY, dt=0.01, integral_error=error, mag=field)
    print(f"north {name}: madgwick {heading(first)} degrees, mahony {heading(second)} degrees")
for name, field in (("as the reference", [1, 0, 0]), ("opposite", [-1, 0, 0]), ("across", [0, 1, 0])):
    metric = mag_consistency_metric(field, [1, 0, 0])
    print(f"field {name}: consistency {metric:.0f}, health {orientation_health_score(0.0, 0.0, 1.0, metric):.2f}")
END
venv/bin/python north.py >seen

cat >expected <<'END'
north ahead: madgwick 0 degrees, mahony 90 degrees
north to the left: madgwick -90 degrees, mahony 0 degrees
field as the reference: consistency 1, health 1.00
field opposite: consistency 1, health 1.00
field across: consistency 0, health 0.75
END
diff expected seen || { echo "CHANGED: qsp-orientation-north-is-two-ways" >&2; exit 1; }
echo "PASS: one filter has a heading of 0 and the other of 90 degrees"
