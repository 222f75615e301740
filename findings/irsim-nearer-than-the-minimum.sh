#!/bin/sh
# SPDX-License-Identifier: MIT
# A wall nearer than the minimal range of a simulated range finder is reported at the minimal range.
#
# Version:   ir-sim 2.12.0.
# Expected:  As ROS has it, such a reading lies below range_min, or is nothing, so that it is discarded.
# Behaviour: The wall at 0.5 m is read as 1.0 m with range_min = 1.0, a valid number in ranges. Only a second array,
#            "valid", is false, as it is for a ray that met nothing.
# Hurts:     Anyone who trains or tests on ranges alone: the robot is in front of a wall and reads twice the distance.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            ir-sim==2.12.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >world.py <<'END'
import irsim
import yaml


def scan(distance: float, **sensor: float) -> dict:
    """Return the scan of a robot that a wall faces at DISTANCE."""
    lidar = {"name": "lidar2d", "range_min": 0.0, "range_max": 5.0, "angle_range": 1.0, "number": 3, "noise": False, **sensor}
    shape = {"name": "circle", "radius": 0.2}
    robot = {"kinematics": {"name": "diff"}, "shape": shape, "state": [5, 5, 0], "sensors": [lidar]}
    wall = {"shape": {"name": "rectangle", "length": 0.2, "width": 9}, "state": [5.1 + distance, 5, 0]}
    world = {"height": 10, "width": 10, "step_time": 0.1, "sample_time": 0.1, "control_mode": "auto"}
    with open("world.yaml", "w") as file:
        yaml.safe_dump({"world": world, "robot": [robot], "obstacle": [wall]}, file)
    return irsim.make("world.yaml", display=False, disable_all_plot=True, log_level="ERROR").get_lidar_scan()
END

cat >near.py <<'END'
from world import scan

for minimum in (0.0, 1.0):
    result = scan(0.5, range_min=minimum)
    print(f"range_min {minimum}:", [round(float(distance), 2) for distance in result["ranges"]], result["valid"].tolist())
END
MPLBACKEND=Agg venv/bin/python near.py 2>/dev/null | grep range_min >seen

cat >expected <<'END'
range_min 0.0: [0.57, 0.5, 0.57] [True, True, True]
range_min 1.0: [1.0, 1.0, 1.0] [False, False, False]
END
diff expected seen || { echo "CHANGED: irsim-nearer-than-the-minimum" >&2; exit 1; }
echo "PASS: the wall at 0.5 m is read as 1.0 m"
