#!/bin/sh
# SPDX-License-Identifier: MIT
# A ray of pybullet that begins inside a box passes its wall, unless the box is a mesh loaded as concave.
#
# Version:   pybullet 3.2.7, numpy 1.26.4.
# Expected:  A ray from inside a closed body meets its wall, or reports a distance of nothing. All shapes of one box
#            agree.
# Behaviour: From inside of a box, or of a mesh as it is loaded by default, the ray goes on to the next body. From
#            inside of a mesh that is loaded as concave it meets the wall. The default mesh is also 1 mm nearer than the
#            others.
# Hurts:     Anyone who simulates a range finder that may touch something, or that stands in a room or a hull: it is
#            blind in one, and sees in the other.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pybullet==3.2.7 numpy==1.26.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >box.obj <<'END'
v -1 -1 -1
v 1 -1 -1
v 1 1 -1
v -1 1 -1
v -1 -1 1
v 1 -1 1
v 1 1 1
v -1 1 1
f 1 3 2
f 1 4 3
f 5 6 7
f 5 7 8
f 1 2 6
f 1 6 5
f 2 3 7
f 2 7 6
f 3 4 8
f 3 8 7
f 4 1 5
f 4 5 8
END
cat >rays.py <<'END'
import pybullet as bullet

bullet.connect(bullet.DIRECT)
concave = bullet.GEOM_FORCE_CONCAVE_TRIMESH
shapes = {
    "box": {"shapeType": bullet.GEOM_BOX, "halfExtents": [1, 1, 1]},
    "mesh": {"shapeType": bullet.GEOM_MESH, "fileName": "box.obj"},
    "concave mesh": {"shapeType": bullet.GEOM_MESH, "fileName": "box.obj", "flags": concave},
}
for number, (name, shape) in enumerate(shapes.items()):
    y = 100 * number
    bullet.createMultiBody(0, bullet.createCollisionShape(**shape), basePosition=[0, y, 0])
    wall = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=[1, 9, 9])
    bullet.createMultiBody(0, wall, basePosition=[5, y, 0])
    ranges = [bullet.rayTest([x, y, 0], [x + 10, y, 0])[0][2] * 10 for x in (-3, 0)]
    print(f"seen: {name}: {ranges[0]:.3f} from before, {ranges[1]:.3f} from inside")
END
venv/bin/python rays.py | grep seen: >seen

cat >expected <<'END'
seen: box: 2.000 from before, 4.000 from inside
seen: mesh: 1.999 from before, 4.000 from inside
seen: concave mesh: 2.000 from before, 1.000 from inside
END
diff expected seen || { echo "CHANGED: pybullet-inside-is-free" >&2; exit 1; }
echo "PASS: from inside a box a ray sees what is behind it, from inside a concave mesh its wall"
