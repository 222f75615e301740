#!/bin/sh
# SPDX-License-Identifier: MIT
# evo compares one pose of the reference with two of the estimate, and then calls its own pairs invalid.
#
# Version:   evo 1.38.1.
# Expected:  Two trajectories are paired one to one: a pose that has a partner is not given to a second.
# Behaviour: Of two poses within the allowed difference to one of the other trajectory both get it. The errors count
#            that place twice, and the paired reference fails the check that evo makes of trajectories, since a time
#            occurs twice.
# Hurts:     Anyone who compares a fast odometry with slow ground truth, or an estimate that was published twice:
#            averages lean to where the poses crowd.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            evo==1.38.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >pair.py <<'END'
import numpy as np
from evo.core import metrics, sync
from evo.core.trajectory import PoseTrajectory3D


def along(times, x):
    """Return a trajectory along x without turns."""
    places = np.zeros((len(times), 3))
    places[:, 0] = x
    return PoseTrajectory3D(places, np.tile([1.0, 0, 0, 0], (len(times), 1)), np.array(times))


reference = along([0.0, 1, 2, 3, 4], [0.0, 1, 2, 3, 4])
estimate = along([0.0, 0.996, 1.004, 2], [0.0, 1.6, 1.6, 2])
print("reference is valid:", reference.check()[0])
reference, estimate = sync.associate_trajectories(reference, estimate, max_diff=0.01)
print("pairs:", [float(t) for t in reference.timestamps], "with", [float(t) for t in estimate.timestamps])
print("reference is valid:", reference.check()[0], "/", reference.check()[1]["timestamps"])
error = metrics.APE(metrics.PoseRelation.translation_part)
error.process_data((reference, estimate))
print(f"mean error {error.get_statistic(metrics.StatisticsType.mean):.2f}, one to one it is 0.20")
END
MPLBACKEND=Agg HOME=$folder venv/bin/python pair.py >seen

cat >expected <<'END'
reference is valid: True
pairs: [0.0, 1.0, 1.0, 2.0] with [0.0, 0.996, 1.004, 2.0]
reference is valid: False / wrong, not ascending or duplicates
mean error 0.30, one to one it is 0.20
END
diff expected seen || { echo "CHANGED: evo-pose-matched-twice" >&2; exit 1; }
echo "PASS: one pose of the reference is paired with two"
