#!/bin/sh
# SPDX-License-Identifier: MIT
# A Create that irobotcreate tells to drive one metre drives on for ever: each step is compared with the whole way.
#
# Version:   irobotcreate 2.1, pyserial 3.5.
# Expected:  drive_forward_to_distance(1000) returns after a metre, turn_ccw_to_angle(90) after a quarter turn,
#            turn_cw_to_angle(90) too. A package that is installed can be imported.
# Behaviour: The robot reports the way since the last question, and the helpers ask every 10 ms: 2 mm at 200 mm/s, which
#            is never 1000. Forward, backward and to the left go on until somebody stops the robot; here it hits a wall
#            after 10 m, or has turned ten times. To the right the steps are added up, but a turn to the right is
#            negative, so 90 is reached at once. The two modules of the sensors that need others cannot be imported as
#            installed, they look for them beside the program.
# Hurts:     Anyone who drives by its helpers. Add up the steps.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            irobotcreate==2.1 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >drive.py <<'END'
import importlib
import sys
import time

for name in ("roomba", "sensor_packets", "sensor_groups", "drive_util"):
    try:
        importlib.import_module(f"irobotcreate.{name}")
        print(f"irobotcreate.{name}: imported")
    except ImportError as error:
        print(f"irobotcreate.{name}: {error}")

import irobotcreate

sys.path.append(irobotcreate.__path__[0])
from irobotcreate.sensor_packets import Angle

time.sleep = lambda seconds: None
# The example at the end of the module drives a robot when it is imported: the class alone is what is asked here.
source = open(f"{irobotcreate.__path__[0]}/drive_util.py").read().split("import time\nfrom IRobotCreate")[0]
helpers = {}
exec(source, helpers)


class Wall(Exception):
    """The robot has come to its limit."""


class Robot:
    """A robot that moves by STEP at each question and has a limit of 5000 questions."""

    def __init__(self, step: int) -> None:
        self.step, self.way = step, 0

    def get_sensor_packet(self, packet) -> None:
        """Answer a question for the way or the angle since the last one."""
        self.way += self.step
        packet.decode((self.step & 0xFFFF).to_bytes(2, "big"), 0)
        if abs(self.way) >= 10000 or isinstance(packet, helpers["Angle"]) and abs(self.way) >= 3600:
            raise Wall


for order, goal, step in (
    ("drive_forward_to_distance", 1000, 2),
    ("drive_backward_to_distance", -1000, -2),
    ("turn_ccw_to_angle", 90, 1),
    ("turn_cw_to_angle", 90, -1),
    ("turn_cw_to_angle", -90, -1),
):
    robot = Robot(step)
    try:
        getattr(helpers["Drive"](robot), order)(goal)
        end = "returned"
    except Wall:
        end = "still at it"
    print(f"{order}({goal}): {end} after {robot.way}")
END
venv/bin/python drive.py >seen

cat >expected <<'END'
irobotcreate.roomba: imported
irobotcreate.sensor_packets: imported
irobotcreate.sensor_groups: No module named 'sensor_packets'
irobotcreate.drive_util: No module named 'sensor_packets'
drive_forward_to_distance(1000): still at it after 10000
drive_backward_to_distance(-1000): still at it after -10000
turn_ccw_to_angle(90): still at it after 3600
turn_cw_to_angle(90): returned after -2
turn_cw_to_angle(-90): returned after -91
END
diff expected seen || { echo "CHANGED: irobotcreate-never-arrives" >&2; exit 1; }
echo "PASS: one metre is never reached"
