#!/bin/sh
# SPDX-License-Identifier: MIT
# A simulated ring of 16 rays looks back twice and never ahead.
#
# Version:   ir-sim 2.12.0.
# Expected:  16 rays over 360 degrees are 22.5 degrees apart, and one looks straight ahead.
# Behaviour: Rays are laid from one end of the range to the other, both included: first and last are one direction, 24
#            degrees lie between the others, and the two nearest to the front look 12 degrees aside. A narrow post
#            ahead is not seen.
# Hurts:     Anyone who models a ring of sonars by the number of its sensors and the full circle.
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

cat >ring.py <<'END'
import math
from world import scan

result = scan(1.0, number=16, angle_range=2 * math.pi)
step = math.degrees(result["angle_increment"])
angles = [round(math.degrees(result["angle_min"]) + step * ray, 1) for ray in range(16)]
print(f"step {step:.1f}, first {angles[0]}, last {angles[-1]}, ahead {angles[7:9]}")
print("nearest", round(float(min(result["ranges"])), 4), "for a wall at 1.0")
END
MPLBACKEND=Agg venv/bin/python ring.py 2>/dev/null | grep -e step -e nearest >seen

cat >expected <<'END'
step 24.0, first -180.0, last 180.0, ahead [-12.0, 12.0]
nearest 1.0223 for a wall at 1.0
END
diff expected seen || { echo "CHANGED: irsim-ring-looks-back-twice" >&2; exit 1; }
echo "PASS: the step is 24 degrees, the rays ahead look 12 degrees aside"
