#!/bin/sh
# SPDX-License-Identifier: MIT
# Robots of gridsim drive into one cell although the world was made with allow_collisions=False.
#
# Version:   gridsim 0.4, pygame-ce 2.5.8, numpy 1.23.5, PyYAML 6.0.4.
# Expected:  Without collisions a cell has one robot at most, and the second one stays where it is.
# Behaviour: The argument is kept and never looked at, at a step as when robots are added: three robots stand in one
#            cell, and neither is told.
# Hurts:     Anyone who tests how robots avoid each other: all runs are free of collisions.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            gridsim==0.4 \
            pygame-ce==2.5.8 \
            numpy==1.23.5 \
            PyYAML==6.0.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >robots.py <<'END'
import contextlib
import io
import sys
from unittest.mock import MagicMock

for module in ("PIL", "h5py"):
    sys.modules[module] = MagicMock()  # for images and logs
with contextlib.redirect_stdout(io.StringIO()):
    from gridsim.grid_robot import GridRobot
    from gridsim.world import World


class Straight(GridRobot):
    """A robot that drives in one direction."""

    def __init__(self, x, y, direction):
        super().__init__(x, y)
        self.direction = direction

    def init(self):
        self.set_direction(self.direction)

    def loop(self):
        pass

    def receive_msg(self, message, distance):
        pass

    def msg_received(self):
        pass


robots = [Straight(0, 2, "right"), Straight(4, 2, "left"), Straight(2, 2, "stay")]
world = World(5, 5, robots=robots, allow_collisions=False)
for step in range(4):
    print(f"step {step}:", *(robot.get_pos() for robot in robots))
    world.step()
END
venv/bin/python robots.py >seen

cat >expected <<'END'
step 0: (0, 2) (4, 2) (2, 2)
step 1: (1, 2) (3, 2) (2, 2)
step 2: (2, 2) (2, 2) (2, 2)
step 3: (3, 2) (1, 2) (2, 2)
END
diff expected seen || { echo "CHANGED: gridsim-collisions-are-allowed" >&2; exit 1; }
echo "PASS: three robots meet in cell 2, 2"
