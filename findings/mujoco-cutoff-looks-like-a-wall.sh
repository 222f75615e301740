#!/bin/sh
# SPDX-License-Identifier: MIT
# A MuJoCo rangefinder with a cutoff reports a wall beyond it as a wall at the cutoff, and empty space as -1.
#
# Version:   mujoco 4.0.0, numpy 2.4.6.
# Expected:  cutoff is the greatest range: what stands beyond it gives the same reading as nothing at all, -1.
# Behaviour: A wall at 1.85 m is read as 1.5 with a cutoff of 1.5, like a wall at 1.5; without any wall the reading is
#            -1. A wall of alpha 0 is not heard at all, one that nothing can touch is.
# Hurts:     Anyone who trains or tests an avoider with short range sensors: each far wall becomes an obstacle at the
#            end of the range.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            mujoco==4.0.0 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >range.py <<'END'
import mujoco

WORLD = """<mujoco><worldbody>{wall}<body><site name="eye" zaxis="1 0 0"/></body></worldbody>
<sensor><rangefinder site="eye" cutoff="1.5"/><rangefinder site="eye"/></sensor></mujoco>"""
WALL = '<geom type="box" pos="{x} 0 0" size=".15 1 1" {more}/>'
for name, wall in (
    ("wall at 1.20 m", WALL.format(x=1.35, more="")),
    ("wall at 1.85 m", WALL.format(x=2.0, more="")),
    ("no wall", ""),
    ("wall at 1.20 m, alpha 0", WALL.format(x=1.35, more='rgba="1 1 1 0"')),
    ("wall at 1.20 m, no contacts", WALL.format(x=1.35, more='contype="0" conaffinity="0"')),
):
    model = mujoco.MjModel.from_xml_string(WORLD.format(wall=wall))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    print(f"{name}: {data.sensordata[0]:.2f} with a cutoff of 1.5, {data.sensordata[1]:.2f} without")
END
venv/bin/python range.py >seen

cat >expected <<'END'
wall at 1.20 m: 1.20 with a cutoff of 1.5, 1.20 without
wall at 1.85 m: 1.50 with a cutoff of 1.5, 1.85 without
no wall: -1.00 with a cutoff of 1.5, -1.00 without
wall at 1.20 m, alpha 0: -1.00 with a cutoff of 1.5, -1.00 without
wall at 1.20 m, no contacts: 1.20 with a cutoff of 1.5, 1.20 without
END
diff expected seen || { echo "CHANGED: mujoco-cutoff-looks-like-a-wall" >&2; exit 1; }
echo "PASS: a wall at 1.85 m is read at the cutoff"
