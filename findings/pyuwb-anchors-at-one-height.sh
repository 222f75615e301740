#!/bin/sh
# SPDX-License-Identifier: MIT
# pyuwb puts each tag to the origin if its four anchors hang at one height: 0, 0, 0 without an error.
#
# Version:   pyuwb 0.0.8, pyserial 3.5.
# Expected:  Anchors at one height give x and y, or an error, since only the height of the tag cannot be found.
# Behaviour: A system of three equations is solved; with anchors in one plane its determinant is 0, and the answer is
#            0, 0, 0, which is a place in the room. A millimetre of difference at one anchor is enough for the right
#            answer.
# Hurts:     Anyone who screws all anchors to one rail or ceiling, which is the usual way: the robot stands in the
#            corner.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pyuwb==0.0.8 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >anchors.py <<'END'
import math

from pyuwb.dingwei import Dingwei

TAG = (3.0, 2.0, 1.0)


def place(heights):
    """Locate a tag by four anchors in the corners of a room."""
    corners = [(0, 8), (0, 0), (6, 0), (6, 8)]
    anchors = [
        {"client_id": f"1-1-{index}", "pos": {"x": x, "y": y, "z": height}}
        for index, ((x, y), height) in enumerate(zip(corners, heights))
    ]
    ranges = {one["client_id"]: math.dist(tuple(one["pos"].values()), TAG) for one in anchors}
    tags = [{"client_id": "1-0-1", "dist": ranges}]
    found = Dingwei().dingwei_biaoqian_dist_to_pos(anchors, tags, using_kalman=0)[0]["pos"]
    return ", ".join(f"{value:.2f}" for value in found.values())


print("tag at", TAG)
for heights in ((2.5, 2.5, 2.5, 2.5), (2.5, 2.5, 2.5, 2.501), (2.5, 2.0, 2.5, 2.0), (2.5, 2.0, 2.5, 3.0)):
    print("anchors at", heights, "->", place(heights))
END
venv/bin/python anchors.py >seen

cat >expected <<'END'
tag at (3.0, 2.0, 1.0)
anchors at (2.5, 2.5, 2.5, 2.5) -> 0.00, 0.00, 0.00
anchors at (2.5, 2.5, 2.5, 2.501) -> 3.00, 2.00, 1.00
anchors at (2.5, 2.0, 2.5, 2.0) -> 3.00, 2.00, 1.00
anchors at (2.5, 2.0, 2.5, 3.0) -> 0.00, 0.00, 0.00
END
diff expected seen || { echo "CHANGED: pyuwb-anchors-at-one-height" >&2; exit 1; }
echo "PASS: with all anchors at 2.5 m the tag is at the origin"
