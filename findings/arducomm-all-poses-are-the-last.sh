#!/bin/sh
# SPDX-License-Identifier: MIT
# With arducomm every pose that was received is the last one: two poses made without arguments share their position
# and their orientation.
#
# Version:   arducomm 0.1.0, pyserial 3.5.
# Expected:  Two messages make two poses.
# Behaviour: The position and the orientation that a Pose has by default are made once, when the class is. parse()
#            makes a Pose by default and writes into them, so all poses, and all Imu, change with each message. A
#            Pose2D does not.
# Hurts:     Anyone who keeps the last pose to compute a speed (it is 0), or records a list of them.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            arducomm==0.1.0 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >poses.py <<'END'
from arducomm.serialization import parse, serialize
from arducomm.types import Imu, Pose, Pose2D, Quaternion, Vector3

received = [serialize(Pose(Vector3(x, 0.0, 0.0), Quaternion())) for x in (1.0, 2.0, 3.0)]
print("Pose:", [parse(data, dtype=Pose).position.x for data in received], "one by one,",
      [pose.position.x for pose in [parse(data, dtype=Pose) for data in received]], "kept")
received = [serialize(Pose2D(x, 0.0, 0.0)) for x in (1.0, 2.0, 3.0)]
print("Pose2D:", [pose.x for pose in [parse(data, dtype=Pose2D) for data in received]], "kept")
turn = parse(serialize(Imu(Quaternion(), Vector3(0.0, 0.0, 0.5), Vector3(0.0, 0.0, 9.75))), dtype=Imu)
print("a new Imu before any message, but one:", Imu())
END
venv/bin/python poses.py >seen

cat >expected <<'END'
Pose: [1.0, 2.0, 3.0] one by one, [3.0, 3.0, 3.0] kept
Pose2D: [1.0, 2.0, 3.0] kept
a new Imu before any message, but one: [0.0, 0.0, 0.0, 1.0] | [0.0, 0.0, 0.5] | [0.0, 0.0, 9.75]]
END
diff expected seen || { echo "CHANGED: arducomm-all-poses-are-the-last" >&2; exit 1; }
echo "PASS: poses of 1, 2 and 3 m are kept as 3, 3 and 3 m"
