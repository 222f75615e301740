#!/bin/sh
# SPDX-License-Identifier: MIT
# easydubins raises an error for a goal straight ahead, and takes headings from the x axis and gives them from the y
# axis.
#
# Version:   easydubins 1.3.1.
# Expected:  A path to a goal straight ahead is a line, and its points have headings of the kind that was put in.
# Behaviour: An arc of length 0 is None, which cannot be joined to the points: TypeError. A point right above the
#            centre of its arc divides by 0, as for a goal ahead and 5 m to the left. Headings go in counter-clockwise
#            from the x axis, and come out clockwise from the y axis: a goal of 0 degrees ends with 90, and one of 90
#            with 360.
# Hurts:     Anyone who drives between way points, of which many are straight ahead.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            easydubins==1.3.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >path.py <<'END'
from easydubins import dubin_path

for name, start, end in (
    ("10 m straight ahead", (0, 0, 0), (10, 0, 0)),
    ("ahead and 5 m to the left", (0, 0, 0), (10, 5, 0)),
    ("ahead and 5 m to the right", (0, 0, 0), (10, -5, 0)),
    ("ahead, then to the left", (0, 0, 0), (10, 10, 90)),
    ("ahead, then to the right", (0, 0, 0), (10, -10, -90)),
):
    try:
        points = dubin_path.get_curve(*start, *end, 1.0, 2.0)
        print(f"{name}: heading {end[2]} asked for, the last point has {points[-1][2]:.0f}")
    except (TypeError, ZeroDivisionError) as error:
        print(f"{name}: {type(error).__name__}: {error}")
END
venv/bin/python path.py >seen

cat >expected <<'END'
10 m straight ahead: TypeError: 'NoneType' object is not iterable
ahead and 5 m to the left: ZeroDivisionError: float division by zero
ahead and 5 m to the right: heading 0 asked for, the last point has 90
ahead, then to the left: heading 90 asked for, the last point has 360
ahead, then to the right: heading -90 asked for, the last point has 180
END
diff expected seen || { echo "CHANGED: easydubins-straight-ahead-raises" >&2; exit 1; }
echo "PASS: a goal straight ahead raises TypeError"
