#!/bin/sh
# SPDX-License-Identifier: MIT
# A radar that turns to the left has a roll and no yaw in pymmWave: get() calls the angle about z roll and the one
# about x yaw.
#
# Version:   pymmWave 1.1.2, scipy 1.14.1, numpy 1.26.4.
# Expected:  get() is x, y, z, roll, pitch, yaw as documented: a turn on the floor is a yaw.
# Behaviour: The rates go in as roll, pitch, yaw, and the first is added to the yaw, the third to the roll. The
#            position is right, since the rotation about z takes what is called roll. A turn by yaw alone comes out as
#            roll, and a roll as yaw.
# Hurts:     Anyone who takes the heading of a robot from the pose, or gives it to another library.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            pymmWave==1.1.2 \
            scipy==1.14.1 \
            numpy==1.26.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >pose.py <<'END'
import math
import warnings

warnings.simplefilter("ignore")

from pymmWave.data_model import ImuVelocityData, Pose

for name, rates in (("yaw", (0, 0, math.pi / 2)), ("roll", (math.pi / 2, 0, 0))):
    pose = Pose()
    pose.move(ImuVelocityData((0, 0, 0), rates), 1.0)
    pose.move(ImuVelocityData((1.0, 0, 0), (0, 0, 0)), 1.0)
    x, y, z, roll, pitch, yaw = pose.get()
    print(f"{name} by 90 degrees, then 1 m ahead: at {x:.0f}, {y:.0f}, {z:.0f}, "
          f"roll {math.degrees(roll):.0f}, pitch {math.degrees(pitch):.0f}, yaw {math.degrees(yaw):.0f}")
END
venv/bin/python pose.py >seen

cat >expected <<'END'
yaw by 90 degrees, then 1 m ahead: at 0, 1, 0, roll 90, pitch 0, yaw 0
roll by 90 degrees, then 1 m ahead: at 1, 0, 0, roll 0, pitch 0, yaw 90
END
diff expected seen || { echo "CHANGED: pymmwave-a-turn-is-a-roll" >&2; exit 1; }
echo "PASS: a turn by 90 degrees is a roll by 90 degrees"
