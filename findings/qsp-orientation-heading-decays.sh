#!/bin/sh
# SPDX-License-Identifier: MIT
# A heading of 90 degrees is 12 after a second in the complementary filter of qsp-orientation, with a gyroscope at rest.
#
# Version:   qsp-orientation 0.1.1, numpy 2.4.6.
# Expected:  An accelerometer says nothing about the heading, so the heading of a complementary filter is that of the
#            gyroscope: 90 degrees stay 90 while nothing turns.
# Behaviour: The attitude by the accelerometer has a heading of 0, and the filter goes a part of the way to it as a
#            whole. With a trust of 0.98 the heading shrinks by 2 per cent at each step, and faster the more often it is
#            called: at 100 Hz 12 degrees are left after one second, at 10 Hz 74. Roll and pitch go to what the
#            accelerometer says, as they should. A turn of 90 degrees a second that is integrated in one step of a
#            second is 76, too.
# Hurts:     Anyone who steers by the heading of it. Take roll and pitch from the filter, and the heading from
#            integrate_gyro in small steps.
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

cat >heading.py <<'END'
import math

from qsp.orientation import complementary_filter, euler_to_quaternion, integrate_gyro, quaternion_to_euler

GRAVITY = [0.0, 0.0, 9.81]


def degrees(attitude) -> str:
    """Return roll, pitch and heading of ATTITUDE as text."""
    return " ".join(f"{math.degrees(angle) + 0.0:.0f}" for angle in quaternion_to_euler(attitude))


for hertz in (10, 100):
    attitude = euler_to_quaternion(math.radians(20), 0, math.radians(90))
    for step in range(hertz):
        attitude = integrate_gyro(attitude, [0.0, 0.0, 0.0], 1 / hertz)
        attitude = complementary_filter(attitude, GRAVITY, 0.98)
        if step in (0, hertz - 1):
            print(f"{hertz} Hz, after {(step + 1) / hertz} s at rest: {degrees(attitude)}")
for hertz in (1, 100):
    attitude = euler_to_quaternion(0, 0, 0)
    for _ in range(hertz):
        attitude = integrate_gyro(attitude, [0.0, 0.0, math.radians(90)], 1 / hertz)
    print(f"90 degrees a second in steps of {1 / hertz} s: {degrees(attitude)}")
END
venv/bin/python heading.py >seen

cat >expected <<'END'
10 Hz, after 0.1 s at rest: 20 0 88
10 Hz, after 1.0 s at rest: 17 2 74
100 Hz, after 0.01 s at rest: 20 0 88
100 Hz, after 1.0 s at rest: 2 2 12
90 degrees a second in steps of 1.0 s: 0 0 76
90 degrees a second in steps of 0.01 s: 0 0 90
END
diff expected seen || { echo "CHANGED: qsp-orientation-heading-decays" >&2; exit 1; }
echo "PASS: a heading of 90 degrees is 12 after a second at rest"
