#!/bin/sh
# SPDX-License-Identifier: MIT
# A ray of pymunk that begins inside a shape hits it at once by its fraction and at its far end by its point.
#
# Version:   pymunk 7.3.1.
# Expected:  A sensor that has run into a wall sees it at a distance of nothing, or at the far side of the wall, or not
#            at all.
# Behaviour: segment_query_first reports a hit with an alpha of 0 and, for the same hit, the end of the ray as its
#            point. Its normal looks like one of a hit from before.
# Hurts:     Anyone who takes the range from the point of the hit: a robot that touches an obstacle sees a free way of
#            full length.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pymunk==7.3.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
import pymunk

space = pymunk.Space()
post = pymunk.Circle(space.static_body, 1)
crate = pymunk.Poly(space.static_body, [(9, -1), (11, -1), (11, 1), (9, 1)])
space.add(post, crate)
for name, x in (("post", 0), ("crate", 10)):
    for place, start in (("before", (x - 3, 0)), ("inside", (x + 0.5, 0))):
        end = (start[0] + 5, 0)
        hit = space.segment_query_first(start, end, 0, pymunk.ShapeFilter())
        by_point = (hit.point - start).length
        print(f"{name}, {place}: {5 * hit.alpha:.2f} by alpha, {by_point:.2f} by point, normal {hit.normal.x:.0f}")
END

cat >expected <<'END'
post, before: 2.00 by alpha, 2.00 by point, normal -1
post, inside: 0.00 by alpha, 5.00 by point, normal -1
crate, before: 2.00 by alpha, 2.00 by point, normal -1
crate, inside: 0.00 by alpha, 5.00 by point, normal -1
END
diff expected seen || { echo "CHANGED: pymunk-inside-hits-the-far-end" >&2; exit 1; }
echo "PASS: from inside a shape the range is 0 by alpha and 5 by the point"
