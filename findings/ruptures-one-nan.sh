#!/bin/sh
# SPDX-License-Identifier: MIT
# One NaN in a signal makes ruptures report 17 changes where there is one, or none.
#
# Version:   ruptures 1.1.10, numpy 1.26.4.
# Expected:  A signal with NaN is refused, or the sample is passed over. The step in the middle is found in either case.
# Behaviour: Pelt reports a change at every fifth sample, its grid, behind the NaN or from the start on. The kernel
#            search reports none. There is no warning.
# Hurts:     Anyone who looks for changes in a stream of ranges where a lost echo is NaN: one of them hides all changes,
#            or invents them.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            ruptures==1.1.10 numpy==1.26.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
import warnings

import numpy as np
import ruptures as rpt

warnings.simplefilter("error")
whole = np.r_[np.zeros(50), np.ones(50)]
holed = whole.copy()
holed[10] = np.nan
for name, signal in (("whole", whole), ("one NaN", holed)):
    for model in ("l2", "rbf"):
        found = [int(at) for at in rpt.Pelt(model).fit(signal).predict(pen=1)]
        print(f"{name}, Pelt {model}: {len(found) - 1} changes, the first at {found[0]}")
    found = [int(at) for at in rpt.KernelCPD("linear").fit(signal).predict(pen=1)]
    print(f"{name}, KernelCPD: {len(found) - 1} changes")
END

cat >expected <<'END'
whole, Pelt l2: 1 changes, the first at 50
whole, Pelt rbf: 1 changes, the first at 50
whole, KernelCPD: 1 changes
one NaN, Pelt l2: 17 changes, the first at 15
one NaN, Pelt rbf: 19 changes, the first at 5
one NaN, KernelCPD: 0 changes
END
diff expected seen || { echo "CHANGED: ruptures-one-nan" >&2; exit 1; }
echo "PASS: one NaN makes 17 changes of one, or none"
