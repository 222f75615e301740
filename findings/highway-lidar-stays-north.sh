#!/bin/sh
# SPDX-License-Identifier: MIT
# The lidar of highway-env does not turn with its vehicle: the first ray looks along the x axis of the world.
#
# Version:   highway-env 1.12.1, gymnasium 1.4.0.
# Expected:  Rays of a sensor on a vehicle are counted from its heading. A vehicle that turns left by 90 degrees has
#            what was ahead of it on its right.
# Behaviour: The obstacle stays in the same ray for every heading. One that the vehicle overlaps is reported at -1 m by
#            some rays, and by others at 0.
# Hurts:     Anyone who learns or tests avoidance with it on roads that bend: the same reading means ahead on one road
#            and aside on another.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            highway-env==1.12.1 gymnasium==1.4.0 numpy==1.26.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >lidar.py <<'END'
import math

import gymnasium
import highway_env  # noqa: F401
import numpy as np
from highway_env.vehicle.objects import Obstacle

lidar = {"type": "LidarObservation", "cells": 16, "maximum_range": 60, "normalize": False}
env = gymnasium.make("highway-v0", config={"observation": lidar, "vehicles_count": 0})
env.reset(seed=0)
world = env.unwrapped


def seen(degrees, distance):
    """Return which rays see an obstacle along x, and how far, from a vehicle that was turned."""
    world.vehicle.heading = math.radians(degrees)
    world.road.objects = [Obstacle(world.road, world.vehicle.position + np.array([distance, 0.0]))]
    ranges = world.observation_type.observe()[:, 0]
    return {ray: round(float(found), 2) for ray, found in enumerate(ranges) if found < 60}


for degrees in (0, 90, 180):
    print("seen: heading", degrees, seen(degrees, 10))
print("seen: overlap, least", min(seen(0, 1).values()))
END
MPLBACKEND=Agg SDL_VIDEODRIVER=dummy venv/bin/python lidar.py 2>/dev/null | grep seen: >seen

cat >expected <<'END'
seen: heading 0 {0: 9.0}
seen: heading 90 {0: 9.0}
seen: heading 180 {0: 9.0}
seen: overlap, least -1.0
END
diff expected seen || { echo "CHANGED: highway-lidar-stays-north" >&2; exit 1; }
echo "PASS: an obstacle stays in ray 0 at every heading"
