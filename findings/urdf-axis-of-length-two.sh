#!/bin/sh
# SPDX-License-Identifier: MIT
# An axis of 0 0 2 lifts by 0.6 m where 0.3 is asked for in kinpy and yourdfpy, and by 0.3 in pytransform3d; a turn is
# the same in all.
#
# Version:   kinpy 0.6.1, pytransform3d 3.17.0, yourdfpy 0.0.60, numpy 2.4.6.
# Expected:  The axis of a joint is a direction: readers normalize it, or all raise an error, for it should have length
#            1.
# Behaviour: A revolute joint is normalized by each of them. A prismatic one is moved by the axis as it stands times
#            the position in two of them, so the same file has two lengths of stroke. An oblique axis of 1 0 1 is too
#            long by 41 %.
# Hurts:     Anyone who slides a sensor obliquely and wrote 1 0 1: it looks right in one tool and stands elsewhere in
#            the other.
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
  <link name="base"/> <link name="turret"/> <link name="slide"/>
  <joint name="pan" type="continuous">
    <parent link="base"/> <child link="turret"/> <axis xyz="{axis}"/>
  </joint>
  <joint name="lift" type="prismatic">
    <parent link="base"/> <child link="slide"/> <axis xyz="{axis}"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/>
  </joint>
</robot>
"""
STATE = {"pan": 0.5, "lift": 0.3}

for axis in ("0 0 1", "0 0 2", "1 0 1"):
    text = ROBOT.format(axis=axis)
    with open("robot.urdf", "w") as file:
        file.write(text)
    links = kinpy.build_chain_from_urdf(text).forward_kinematics(STATE)
    manager = UrdfTransformManager()
    manager.load_urdf(text)
    for joint, value in STATE.items():
        manager.set_joint(joint, value)
    model = URDF.load("robot.urdf", load_meshes=False)
    model.update_cfg(STATE)
    for name, pose in (
        ("kinpy", lambda link: links[link].matrix()),
        ("pytransform3d", lambda link: manager.get_transform(link, "base")),
        ("yourdfpy", lambda link: model.get_transform(link, "base")),
    ):
        angle = np.arccos((np.trace(pose("turret")[:3, :3]) - 1) / 2)
        stroke = np.linalg.norm(pose("slide")[:3, 3])
        print(f"axis {axis}, {name}: turned by {angle:.3f} rad, moved by {stroke:.3f} m")
END
venv/bin/python axis.py >seen

cat >expected <<'END'
axis 0 0 1, kinpy: turned by 0.500 rad, moved by 0.300 m
axis 0 0 1, pytransform3d: turned by 0.500 rad, moved by 0.300 m
axis 0 0 1, yourdfpy: turned by 0.500 rad, moved by 0.300 m
axis 0 0 2, kinpy: turned by 0.500 rad, moved by 0.600 m
axis 0 0 2, pytransform3d: turned by 0.500 rad, moved by 0.300 m
axis 0 0 2, yourdfpy: turned by 0.500 rad, moved by 0.600 m
axis 1 0 1, kinpy: turned by 0.500 rad, moved by 0.424 m
axis 1 0 1, pytransform3d: turned by 0.500 rad, moved by 0.300 m
axis 1 0 1, yourdfpy: turned by 0.500 rad, moved by 0.424 m
END
diff expected seen || { echo "CHANGED: urdf-axis-of-length-two" >&2; exit 1; }
echo "PASS: an axis of length two doubles the stroke in two of three readers"
