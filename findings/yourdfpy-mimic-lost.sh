#!/bin/sh
# SPDX-License-Identifier: MIT
# A robot that yourdfpy reads and writes has one free joint more: it moves mimic joints and does not write them.
#
# Version:   yourdfpy 0.0.60.
# Expected:  What yourdfpy knows of a joint is in the URDF that it writes.
# Behaviour: The mimic element is used for the kinematics and is missing in what is written, as is the safety
#            controller. The same robot read again has its follower at 0.
# Hurts:     Anyone who changes a URDF by program: a sensor head that is geared to another joint stands still, and a
#            controller waits for a joint that nobody drives.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            yourdfpy==0.0.60 numpy==1.26.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >head.urdf <<'END'
<robot name="head">
<link name="base"/><link name="neck"/><link name="sonar"/>
<joint name="pan" type="continuous"><parent link="base"/><child link="neck"/><axis xyz="0 0 1"/></joint>
<joint name="geared" type="continuous"><parent link="neck"/><child link="sonar"/><axis xyz="0 0 1"/>
<mimic joint="pan" multiplier="-2" offset="0.5"/></joint>
</robot>
END
cat >rewrite.py <<'END'
import math

import yourdfpy


def shown(file):
    """Load a robot, turn its pan joint by 1 rad and tell where the sonar looks."""
    robot = yourdfpy.URDF.load(file, load_meshes=False)
    robot.update_cfg({"pan": 1.0})
    turn = robot.get_transform("sonar", "neck")
    print("seen", file, robot.actuated_joint_names, f"geared joint at {math.atan2(turn[1, 0], turn[0, 0]):.2f}")
    return robot


shown("head.urdf").write_xml_file("written.urdf")
shown("written.urdf")
END
venv/bin/python rewrite.py 2>/dev/null | grep '^seen' >seen

cat >expected <<'END'
seen head.urdf ['pan'] geared joint at -1.50
seen written.urdf ['pan', 'geared'] geared joint at 0.00
END
diff expected seen || { echo "CHANGED: yourdfpy-mimic-lost" >&2; exit 1; }
echo "PASS: a mimic joint is a free one after yourdfpy wrote it"
