#!/bin/sh
# SPDX-License-Identifier: MIT
# Of the binary drift detectors of river four take 1 for an error, and FHDDM takes 1 for a success.
#
# Version:   river 0.26.1.
# Expected:  All detectors of one module read the same stream: they report a drift where errors become frequent.
# Behaviour: DDM, EDDM and both HDDM report that errors rise from 5 to 60 of 100. FHDDM says nothing then, and reports a
#            drift where they fall from 60 to 5.
# Hurts:     Anyone who swaps one detector for another: it is silent as long as things get worse, and raises an alarm at
#            the repair.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            river==0.26.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
import random

from river.drift import binary

chance = random.Random(1)
rising = [chance.random() < 0.05 for _ in range(1000)] + [chance.random() < 0.6 for _ in range(1000)]


def drifts(name, errors):
    """Return whether a detector reports any drift in a stream of errors."""
    detector = getattr(binary, name)()
    found = False
    for error in errors:
        detector.update(error)
        found |= detector.drift_detected
    return "drift" if found else "nothing"


for name in ("DDM", "EDDM", "HDDMA", "HDDMW", "FHDDM"):
    print(f"{name}: errors rise: {drifts(name, rising)}, errors fall: {drifts(name, rising[::-1])}")
END

cat >expected <<'END'
DDM: errors rise: drift, errors fall: nothing
EDDM: errors rise: drift, errors fall: nothing
HDDMA: errors rise: drift, errors fall: nothing
HDDMW: errors rise: drift, errors fall: nothing
FHDDM: errors rise: nothing, errors fall: drift
END
diff expected seen || { echo "CHANGED: river-fhddm-upside-down" >&2; exit 1; }
echo "PASS: FHDDM reports that errors fall, the others that they rise"
