#!/bin/sh
# SPDX-License-Identifier: MIT
# A robot in the middle of an obstacle is free for the KDTree of corgipath, and in collision for its bounding volume
# hierarchy.
#
# Version:   corgipath 0.1.0a1, collision 1.2.2, aabbtree 2.8.1, shapely 2.0.7, scipy 1.10.1, numpy 1.23.5.
# Expected:  Both classes, which take the same obstacles and the same robot, agree where it may be.
# Behaviour: The KDTree keeps points of the outline alone. A robot that is farther from the outline than its own size
#            is free, inside as outside, so the planner may start and end in there. Far outside of the bounds both
#            report it free.
# Hurts:     Anyone who takes the faster class for large obstacles, or goals from a user.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            corgipath==0.1.0a1 \
            collision==1.2.2 \
            aabbtree==2.8.1 \
            shapely==2.0.7 \
            scipy==1.10.1 \
            numpy==1.23.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >inside.py <<'END'
import sys
from unittest.mock import MagicMock

for module in ("PIL", "matplotlib", "matplotlib.pyplot"):
    sys.modules[module] = MagicMock()  # for pictures

import collision
from corgipath.collision import BoundingVolumeHierarchy, KDTree

BOUNDS = (-5.0, 5.0, -5.0, 5.0)
box = collision.Poly(collision.Vector(2.0, 0.0), [collision.Vector(x, y) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))])
ways = {"KDTree": KDTree(BOUNDS, 0.1), "hierarchy": BoundingVolumeHierarchy(BOUNDS)}
for way in ways.values():
    way.add_obstacles([box])
    way.build()
    way.agent_collision = collision.Circle(collision.Vector(0, 0), 0.3)
for name, place in (("clear of the box", (0.0, 0.0)), ("at its edge", (1.1, 0.0)), ("in its middle", (2.0, 0.0)), ("10 m outside of the bounds", (15.0, 0.0))):
    print(f"{name}:", *(f"{kind} {'hit' if way.has_collision((*place, 0.0)) else 'free'}" for kind, way in ways.items()))
END
venv/bin/python inside.py >seen

cat >expected <<'END'
clear of the box: KDTree free hierarchy free
at its edge: KDTree hit hierarchy hit
in its middle: KDTree free hierarchy hit
10 m outside of the bounds: KDTree free hierarchy free
END
diff expected seen || { echo "CHANGED: corgipath-inside-is-free" >&2; exit 1; }
echo "PASS: in the middle of a box the KDTree is free"
