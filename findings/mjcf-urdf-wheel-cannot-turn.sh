#!/bin/sh
# SPDX-License-Identifier: MIT
# A wheel of a MuJoCo model cannot turn in the URDF that mjcf_urdf_simple_converter makes of it: no limits become limits
# of 0 and 0.
#
# Version:   mjcf_urdf_simple_converter 0.7.3, mujoco 3.3.7, yourdfpy 0.0.60, scipy 1.17.1, numpy 2.4.6.
# Expected:  A hinge without a range becomes a continuous joint, a slide a prismatic one, and a robot of boxes and
#            cylinders keeps its shapes.
# Behaviour: Each hinge is revolute with the range of the compiled model, which is 0 0 where there is none. A slide is
#            fixed, which a line on the screen says, and what hangs on it is moved aside by the place of the joint.
#            Shapes other than meshes are left out without a word. A model with no meshes at all has links without any
#            shape, and a folder meshes that is empty.
# Hurts:     Anyone who takes a wheeled robot from MuJoCo to ROS. Write the limits and types by hand.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            mjcf_urdf_simple_converter==0.7.3 \
            mujoco==3.3.7 \
            yourdfpy==0.0.60 \
            scipy==1.17.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >wheel.py <<'END'
import contextlib
import io
import logging

import mujoco
from mjcf_urdf_simple_converter import convert
from yourdfpy import URDF

logging.disable()
MODEL = """<mujoco> <worldbody>
  <body name="base"> <geom name="hull" type="box" size="0.2 0.15 0.1"/>
    <body name="wheel" pos="0 0.2 0"> <joint name="turn" type="hinge" axis="0 1 0"/> <geom type="cylinder" size="0.1 0.02"/> </body>
    <body name="gripper" pos="0.3 0 0"> <joint name="grip" type="hinge" axis="0 0 1" range="-30 30"/> <geom type="sphere" size="0.02"/> </body>
    <body name="mast" pos="0 0 0.1"> <joint name="lift" type="slide" axis="0 0 1" pos="0.05 0 0" range="0 0.5"/> <geom type="box" size="0.02 0.02 0.2"/> </body>
  </body>
</worldbody> </mujoco>"""
with open("robot.xml", "w") as file:
    file.write(MODEL)
model = mujoco.MjModel.from_xml_path("robot.xml")
data = mujoco.MjData(model)
mujoco.mj_forward(model, data)
with contextlib.redirect_stdout(io.StringIO()) as said:
    convert("robot.xml", "robot.urdf")
robot = URDF.load("robot.urdf", load_meshes=False)
for name in ("turn", "grip", "lift"):
    joint = robot.joint_map[name]
    limits = f", {joint.limit.lower:.2f} to {joint.limit.upper:.2f}" if joint.limit else ""
    bound = "limited" if model.joint(name).limited[0] else "free"
    print(f"{name}: {bound} in MuJoCo, {joint.type} in URDF{limits}")
place = [round(float(value), 2) for value in robot.get_transform("mast", "world")[:3, 3]]
print("mast: MuJoCo", [round(float(value), 2) for value in data.body("mast").xpos], "URDF", place)
print("shapes: MuJoCo", model.ngeom, "URDF", sum(len(link.visuals) for link in robot.link_map.values()))
print("said:", *(line.split(" [")[0] for line in said.getvalue().splitlines()))
END
venv/bin/python wheel.py >seen

cat >expected <<'END'
turn: free in MuJoCo, revolute in URDF, 0.00 to 0.00
grip: limited in MuJoCo, revolute in URDF, -0.52 to 0.52
lift: limited in MuJoCo, fixed in URDF
mast: MuJoCo [0.0, 0.0, 0.1] URDF [-0.05, 0.0, 0.1]
shapes: MuJoCo 4 URDF 0
said: doesn't support joint type 2, treating as fixed joint...
END
diff expected seen || { echo "CHANGED: mjcf-urdf-wheel-cannot-turn" >&2; exit 1; }
echo "PASS: a wheel has limits of 0 and 0"
