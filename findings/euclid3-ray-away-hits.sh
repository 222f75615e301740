#!/bin/sh
# SPDX-License-Identifier: MIT
# In euclid3 a ray that points away from a circle hits it where the ray begins, and a segment that is too short to
# reach it hits it at its end.
#
# Version:   euclid3 0.01.
# Expected:  No intersection is None, as it is for two segments that do not meet and for a line that passes a circle.
# Behaviour: The two solutions on the endless line are moved to the nearest end of the ray or segment, and what remains
#            is returned as a point. The line of a ray that points away does cross the circle, behind it: the answer is
#            its origin, distance 0.
# Hurts:     Anyone who simulates range finders among pillars by it: what is behind the sensor is at 0 m, and what is
#            out of range is at the range.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            euclid3==0.01 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >ray.py <<'END'
from euclid3 import Circle, Line2, LineSegment2, Point2, Ray2, Vector2

pillar = Circle(Point2(3.0, 0.0), 1.0)
for name, beam in (
    ("line that passes it", Line2(Point2(0.0, 2.0), Vector2(1.0, 0.0))),
    ("ray towards it", Ray2(Point2(0.0, 0.0), Vector2(1.0, 0.0))),
    ("ray away from it", Ray2(Point2(0.0, 0.0), Vector2(-1.0, 0.0))),
    ("segment of 5 m", LineSegment2(Point2(0.0, 0.0), Vector2(5.0, 0.0))),
    ("segment of 1 m", LineSegment2(Point2(0.0, 0.0), Vector2(1.0, 0.0))),
):
    print(f"{name}: {beam.intersect(pillar)}")
END
venv/bin/python ray.py >seen

cat >expected <<'END'
line that passes it: None
ray towards it: LineSegment2(<4.00, 0.00> to <2.00, 0.00>)
ray away from it: Point2(0.00, 0.00)
segment of 5 m: LineSegment2(<4.00, 0.00> to <2.00, 0.00>)
segment of 1 m: Point2(1.00, 0.00)
END
diff expected seen || { echo "CHANGED: euclid3-ray-away-hits" >&2; exit 1; }
echo "PASS: a ray that points away hits at distance 0"
