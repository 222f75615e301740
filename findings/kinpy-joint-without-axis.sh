#!/bin/sh
# SPDX-License-Identifier: MIT
# A joint without an axis turns about z in kinpy, where URDF says x, as pytransform3d and yourdfpy have it.
#
# Version:   kinpy 0.6.1, pytransform3d 3.17.0, yourdfpy 0.0.60, numpy 2.4.6.
# Expected:  An axis that is left out is 1 0 0, as the format defines, in each reader of URDF.
# Behaviour: kinpy takes 0 0 1. A sonar that is tilted by such a joint pans, and one that slides ahead is lifted.
#            Nothing is said about the missing element.
# Hurts:     Anyone who tilts or slides a sensor by a joint that relies on the default: the model is right in the
#            viewer and wrong in the planner.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            kinpy==0.6.1 \
            pytransform3d==3.17.0 \
            yourdfpy==0.0.60 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >axis.py <<'END'
import logging

import kinpy
import numpy as np
from pytransform3d.urdf import UrdfTransformManager
from yourdfpy import URDF

logging.disable()
ROBOT = """<robot name="robot">
  <link name="base"/> <link name="sonar"/> <link name="slide"/>
  <joint name="tilt" type="revolute">
    <parent link="base"/> <child link="sonar"/>
    <limit lower="-1" upper="1" effort="1" velocity="1"/>
  </joint>
  <joint name="reach" type="prismatic">
    <parent link="base"/> <child link="slide"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>
"""
STATE = {"tilt": 0.4, "reach": 0.3}
with open("robot.urdf", "w") as file:
    file.write(ROBOT)

links = kinpy.build_chain_from_urdf(ROBOT).forward_kinematics(STATE)
manager = UrdfTransformManager()
manager.load_urdf(ROBOT)
for joint, value in STATE.items():
    manager.set_joint(joint, value)
model = URDF.load("robot.urdf", load_meshes=False)
model.update_cfg(STATE)

for name, pose in (
    ("kinpy", lambda link: links[link].matrix()),
    ("pytransform3d", lambda link: manager.get_transform(link, "base")),
    ("yourdfpy", lambda link: model.get_transform(link, "base")),
):
    turned, moved = pose("sonar"), pose("slide")
    axis = np.array([turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]])
    axis = np.round(axis / np.linalg.norm(axis), 3) + 0
    print(f"{name}: turned about {axis.tolist()}, moved to {(np.round(moved[:3, 3], 3) + 0).tolist()}")
END
venv/bin/python axis.py >seen

cat >expected <<'END'
kinpy: turned about [0.0, 0.0, 1.0], moved to [0.0, 0.0, 0.3]
pytransform3d: turned about [1.0, 0.0, 0.0], moved to [0.3, 0.0, 0.0]
yourdfpy: turned about [1.0, 0.0, 0.0], moved to [0.3, 0.0, 0.0]
END
diff expected seen || { echo "CHANGED: kinpy-joint-without-axis" >&2; exit 1; }
echo "PASS: the joint turns about z in kinpy and about x in the others"
