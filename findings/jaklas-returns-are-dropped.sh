#!/bin/sh
# SPDX-License-Identifier: MIT
# jaklas writes a LAS file without the return numbers, scan angles and sources that it was given: all of them are 0
# when the file is read.
#
# Version:   jaklas 0.4.4, laspy 2.0.3, pyproj 3.7.2, numpy 2.4.6.
# Expected:  Each key that is a field of the LAS format is written to it, and each other one to an extra field, as its
#            documentation says for the latter.
# Behaviour: Coordinates, intensity, class, time and colours are written, and keys that LAS does not know. Keys that
#            LAS knows beyond these are neither: the point format is chosen so that they fit, and they stay 0. A key
#            with a wrong spelling survives, the right one does not.
# Hurts:     Anyone who keeps only last returns, sorts by angle or joins the scans of several sensors.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            jaklas==0.4.4 \
            laspy==2.0.3 \
            pyproj==3.7.2 \
            certifi==2026.10.19.post1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >returns.py <<'END'
import jaklas
import laspy
import numpy as np

given = {
    "xyz": np.array([[1.0, 0.5, 0.3], [2.0, -0.5, 0.2], [3.0, 0.0, 0.2]]),
    "intensity": np.array([10, 20, 30], "u2"),
    "return_number": np.array([1, 2, 1], "u1"),
    "number_of_returns": np.array([1, 2, 1], "u1"),
    "scan_angle": np.array([100, 200, 300], "i2"),
    "point_source_id": np.array([1, 2, 3], "u2"),
    "retrun_number": np.array([1, 2, 1], "u1"),
}
jaklas.write(given, "scan.las")
read = laspy.read("scan.las")
for name, values in given.items():
    if name != "xyz":
        print(f"{name}: written {values.tolist()}, read {np.array(read[name]).tolist()}")
END
venv/bin/python returns.py >seen

cat >expected <<'END'
intensity: written [10, 20, 30], read [10, 20, 30]
return_number: written [1, 2, 1], read [0, 0, 0]
number_of_returns: written [1, 2, 1], read [0, 0, 0]
scan_angle: written [100, 200, 300], read [0, 0, 0]
point_source_id: written [1, 2, 3], read [0, 0, 0]
retrun_number: written [1, 2, 1], read [1, 2, 1]
END
diff expected seen || { echo "CHANGED: jaklas-returns-are-dropped" >&2; exit 1; }
echo "PASS: return numbers are written as 0"
