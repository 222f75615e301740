#!/bin/sh
# SPDX-License-Identifier: MIT
# EulerAngles(90) of pypozyx has a heading of 5.6 degrees, while a heading that is set to 90 is 90.
#
# Version:   pypozyx 1.3.0, pyserial 3.5.
# Expected:  A container in degrees, microtesla or degrees per second takes such values when it is made, as its setters
#            do.
# Behaviour: The arguments are stored as the raw numbers of the sensor, and divided when they are read. The setters
#            multiply. A temperature prints as the code that was meant to print it.
# Hurts:     Anyone who makes values for tests or for a simulated tag: a heading of 90 is one of 5.625, and a
#            quaternion of w=1 is nearly nothing.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pypozyx==1.3.0 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >containers.py <<'END'
from pypozyx import AngularVelocity, EulerAngles, Magnetic, Quaternion, Temperature

angles = EulerAngles(90)
print("EulerAngles(90):", angles.heading)
angles.heading = 90
print("heading set to 90:", angles.heading)
print("AngularVelocity(90):", AngularVelocity(90).x)
print("Magnetic(48):", Magnetic(48).x)
print("Quaternion(w=1):", Quaternion(w=1).w)
print("Temperature(20):", Temperature(20).value, "printed as", Temperature(20))
END
venv/bin/python containers.py >seen 2>stderr

cat >expected <<'END'
EulerAngles(90): 5.625
heading set to 90: 90.0
AngularVelocity(90): 5.625
Magnetic(48): 3.0
Quaternion(w=1): 6.103515625e-05
Temperature(20): 20.0 printed as {self.value} °C
END
diff expected seen || { echo "CHANGED: pypozyx-made-at-90-is-at-5" >&2; exit 1; }
echo "PASS: a heading made as 90 is 5.625"
