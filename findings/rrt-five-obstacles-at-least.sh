#!/bin/sh
# SPDX-License-Identifier: MIT
# rrt cannot plan among fewer than five obstacles: it asks for the five nearest ones, and raises IndexError where there
# are four, and ValueError where there is none.
#
# Version:   rrt 0.1.1, scipy 1.17.1, matplotlib 3.11.2, numpy 1.26.4.
# Expected:  A world with three obstacles is a simpler one than a world with thirty.
# Behaviour: The tree of centres answers with a number behind the last one for each neighbour that is missing, and that
#            is looked up. Of many obstacles the five with the nearest centres are tested, so a long wall whose centre
#            is far is not there.
# Hurts:     Anyone who begins with an empty room or a single box. Five tiny obstacles in a corner help.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            rrt==0.1.1 \
            scipy==1.17.1 \
            matplotlib==3.11.2 \
            numpy==1.26.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >few.py <<'END'
import os

os.environ["MPLBACKEND"] = "Agg"

import numpy as np
from rrt.environment import StaticEnvironment

np.random.seed(1)
for count in (30, 5, 4, 3, 1, 0):
    try:
        found = "tested" if StaticEnvironment((100, 100), count).is_free(50, 50) in (True, False) else "nothing"
    except (IndexError, ValueError) as error:
        found = type(error).__name__
    print(f"{count} obstacles: {found}")
END
venv/bin/python few.py >seen

cat >expected <<'END'
30 obstacles: tested
5 obstacles: tested
4 obstacles: IndexError
3 obstacles: IndexError
1 obstacles: IndexError
0 obstacles: ValueError
END
diff expected seen || { echo "CHANGED: rrt-five-obstacles-at-least" >&2; exit 1; }
echo "PASS: four obstacles raise IndexError"
