#!/bin/sh
# SPDX-License-Identifier: MIT
# The lidar of discoverySimulator goes on reporting an obstacle that has gone, for as long as nothing else comes into
# that direction.
#
# Version:   discoverySimulator 1.0.0, PyQt5 5.15.11.
# Expected:  A direction in which nothing is any more has no distance, or the greatest one, as the telemeter of the
#            package has it.
# Behaviour: The distance of a direction is written only when something is hit there. After an obstacle was removed, or
#            the robot has turned away from it, getValue() has the old distance with the old bearing.
# Hurts:     Anyone who avoids obstacles in it: the robot stops before a box that was taken away, and after a turn it
#            drags the room with it. Turn through by a new lidar, or compare with a telemeter.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            discoverySimulator==1.0.0 \
            PyQt5==5.15.11 \
            PyQt5-sip==12.17.0 \
            PyQt5-Qt5==5.15.17 &&
        QT_QPA_PLATFORM=offscreen venv/bin/python -c 'import PyQt5.QtWidgets' || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >gone.py <<'END'
import os

os.environ["QT_QPA_PLATFORM"] = "offscreen"

from discoverySimulator import Object, Pose
from discoverySimulator.config import config
from discoverySimulator.representation import Representation
from discoverySimulator.representation.shapes import Rectangle
from discoverySimulator.sensors import LIDAR, Telemeter
from discoverySimulator.simulation import Environment

config["real_update_time_step"] = 0.02


def look(sensor):
    for _ in range(200):  # several turns of the lidar
        sensor.refresh()
    value = sensor.getValue()
    if not isinstance(value, list):
        return f"{round(value)}"
    near = [round(distance) for _, distance in filter(None, value) if distance < 400]
    return f"{len(near)} bearings, nearest {min(near, default=None)}"


for make in (Telemeter, LIDAR):
    world = Environment(1000, 1000)
    sensor = make(maximumMeasurableDistance=400)
    world.addObject(sensor, 500, 500)
    box = Object(Representation(Rectangle(100, 100)))
    world.addObject(box, 500, 700)
    print(f"{make.__name__}: with a box: {look(sensor)}", end="; ")
    world.removeObject(box)
    print("without:", look(sensor))
END
venv/bin/python gone.py >seen

cat >expected <<'END'
Telemeter: with a box: 150; without: 400
LIDAR: with a box: 27 bearings, nearest 150; without: 27 bearings, nearest 150
END
diff expected seen || { echo "CHANGED: discoverysimulator-lidar-remembers" >&2; exit 1; }
echo "PASS: a box that was removed is still at its distance"
