#!/bin/sh
# SPDX-License-Identifier: MIT
# A robot of multiped that is told to walk raises NotImplementedError, and one that is told to turn on the spot gets no
# steps.
#
# Version:   multiped 0.5.1, pyservos 1.0.2, pyserial 3.5.
# Expected:  The command of the gait that the package has takes x, y and a rotation, and returns the positions of all
#            four feet.
# Behaviour: command() hands on to oneCycle_alt(), which the only gait has not got; its own is called oneCycle(). A
#            rotation without a way falls between the conditions, and is None as standing still is. With the versions of
#            pyservos that its metadata asks for, from 2.0.1 on, it cannot even be imported.
# Hurts:     Anyone who drives a quadruped by command(). oneCycle(x, y, rotation) works, for unit vectors and up to a
#            quarter turn.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            multiped==0.5.1 \
            pyservos==1.0.2 \
            pyserial==3.5 \
            simplejson==3.20.2 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >walk.py <<'END'
from multiped.Gait import DiscreteRippleGait

gait = DiscreteRippleGait(65.0, [100.0, 0.0, -70.0])
for name, order in (
    ("ahead", [1.0, 0.0, 0.0]),
    ("to the side while turning", [0.0, 1.0, 0.5]),
    ("turning by 1 rad on the spot", [0.0, 0.0, 1.0]),
    ("standing", [0.0, 0.0, 0.0]),
):
    try:
        steps = gait.command(order)
    except NotImplementedError as error:
        steps = "NotImplementedError"
    print(f"{name}: {steps}")
steps = gait.oneCycle(1.0, 0.0, 0.0)
print("oneCycle ahead:", {leg: len(feet) for leg, feet in steps.items()})
END
venv/bin/python walk.py >seen

cat >expected <<'END'
ahead: NotImplementedError
to the side while turning: NotImplementedError
turning by 1 rad on the spot: None
standing: None
oneCycle ahead: {0: 12, 1: 12, 2: 12, 3: 12}
END
diff expected seen || { echo "CHANGED: multiped-cannot-walk" >&2; exit 1; }
echo "PASS: walking raises and turning is None"
