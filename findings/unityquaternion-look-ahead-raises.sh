#!/bin/sh
# SPDX-License-Identifier: MIT
# UnityQuaternionPy cannot look at anything on its own level: LookRotation raises ZeroDivisionError for each direction
# on the floor.
#
# Version:   UnityQuaternionPy 0.1.2.
# Expected:  LookRotation(0, 0, 1) is the identity, as in the library that is imitated, and a turn from a direction to
#            itself is one by 0.
# Behaviour: A turn between two directions is made by its axis, which has length 0 if they are one. For a level
#            direction the turn of the upper side is such a one. Angle of a rotation and itself raises ValueError where
#            the product is rounded to more than 1, and is 360 where one has all signs turned.
# Hurts:     Anyone who turns a robot on the floor towards a goal.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            UnityQuaternionPy==0.1.2 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >look.py <<'END'
from UnityQuaternion import Quaternion


def shown(name, call):
    try:
        print(f"{name}: {call()}")
    except (ValueError, ZeroDivisionError) as error:
        print(f"{name}: {type(error).__name__}")


for name, direction in (("ahead", (0, 0, 1)), ("left", (-1, 0, 0)), ("half right", (1, 0, 1)), ("ahead and up", (0, 0.1, 1)), ("right and up", (1, 0.1, 0))):
    shown(f"look {name}", lambda: Quaternion.LookRotation(direction).ToString(3))
shown("from ahead to ahead", lambda: Quaternion.FromToRotation((0, 0, 1), (0, 0, 1)).ToString(3))
turn = Quaternion.AngleAxis(33.0, (0.0, 1.0, 0.0))
same = Quaternion(-turn.x, -turn.y, -turn.z, -turn.w)
shown("angle between a turn and itself", lambda: Quaternion.Angle(turn, turn))
shown("angle between a turn and itself, signs turned", lambda: Quaternion.Angle(turn, same))
raises = sum(1 for degrees in range(360) if (q := Quaternion.AngleAxis(degrees, (1, 2, 3))) and Quaternion.Dot(q, q) > 1)
print(f"of 360 turns {raises} have a product with themselves above 1")
END
venv/bin/python look.py >seen

cat >expected <<'END'
look ahead: ZeroDivisionError
look left: ZeroDivisionError
look half right: ZeroDivisionError
look ahead and up: ZeroDivisionError
look right and up: (-0.035, 0.706, 0.035, 0.706)
from ahead to ahead: ZeroDivisionError
angle between a turn and itself: 0.0
angle between a turn and itself, signs turned: 360.0
of 360 turns 68 have a product with themselves above 1
END
diff expected seen || { echo "CHANGED: unityquaternion-look-ahead-raises" >&2; exit 1; }
echo "PASS: looking ahead or left raises ZeroDivisionError"
