#!/bin/sh
# SPDX-License-Identifier: MIT
# A cell that is masked in numpy is free in the map that rosnumpy makes of it, and the map changes the info of the map
# that it was copied from.
#
# Version:   rosnumpy 0.0.6.2, rosbag-standalone 1.17.4.1, numpy 1.26.4.
# Expected:  A masked cell is unknown, -1, as an unknown cell is masked on the way to numpy.
# Behaviour: The mask is thrown away and the number under it is taken: where it is 0 the cell is free. Cells that were
#            unknown all along come back as -1, since that is under their mask. The info that is passed is not copied:
#            the size of the other map becomes that of the new one.
# Hurts:     Anyone who masks what a sensor cannot see, or cuts a piece out of a map.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            rosnumpy==0.0.6.2 \
            rosbag-standalone==1.17.4.1 \
            PyYAML==6.0.4 \
            lz4==4.4.5 \
            numpy==1.26.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >map.py <<'END'
import importlib.util
import pathlib
import sys
import types

import numpy as np
from genpy.dynamic import generate_dynamic

LINE = "=" * 80
GRID = f"""MapMetaData info
int8[] data
{LINE}
MSG: nav_msgs/MapMetaData
float32 resolution
uint32 width
uint32 height
"""
made = generate_dynamic("nav_msgs/OccupancyGrid", GRID)
nav_msgs = sys.modules["nav_msgs"] = types.ModuleType("nav_msgs")
nav_msgs.msg = sys.modules["nav_msgs.msg"] = types.ModuleType("nav_msgs.msg")
OccupancyGrid = nav_msgs.msg.OccupancyGrid = made["nav_msgs/OccupancyGrid"]
nav_msgs.msg.MapMetaData = made["nav_msgs/MapMetaData"]
package = sys.modules["ros_numpy"] = types.ModuleType("ros_numpy")  # without its parts for images and clouds
package.numpy_msg = lambda message: message
package.__path__ = [str(pathlib.Path(importlib.util.find_spec("genpy").origin).parents[1] / "ros_numpy")]

from ros_numpy.occupancy_grid import numpy_to_occupancy_grid, occupancygrid_to_numpy

whole = OccupancyGrid()
whole.info.resolution, whole.info.width, whole.info.height = 0.05, 3, 2
whole.data = [0, 100, -1, 0, 0, 100]
cells = occupancygrid_to_numpy(whole)
print("read:", cells.tolist())
cells = np.ma.array(cells, copy=True)
cells[0, 0] = np.ma.masked
print("one more masked:", cells.tolist())
piece = numpy_to_occupancy_grid(cells[:1], info=whole.info)
print("written:", list(piece.data))
print(f"the whole map is now {whole.info.height} x {whole.info.width} for {len(whole.data)} cells")
END
venv/bin/python map.py >seen

cat >expected <<'END'
read: [[0, 100, None], [0, 0, 100]]
one more masked: [[None, 100, None], [0, 0, 100]]
written: [0, 100, -1]
the whole map is now 1 x 3 for 6 cells
END
diff expected seen || { echo "CHANGED: rosnumpy-masked-is-free" >&2; exit 1; }
echo "PASS: a cell that was masked is written as 0, free"
