#!/bin/sh
# SPDX-License-Identifier: MIT
# read_mm of mr-di-sensors, for the GoPiGo3, keeps reporting the last obstacle when nothing is ahead any more, and a
# failed reading is a distance of 0 in its mean.
#
# Version:   mr-di-sensors 0.0.3.
# Expected:  3000 when the range is exceeded, as its documentation says, and an error or the last value when the sensor
#            cannot be read.
# Behaviour: Only distances below 8 m enter the mean of the last three. The sensor reports 8190 for nothing; after two
#            real distances that value is replaced by their old mean for as long as nothing is there. After an error on
#            the bus 0 enters the mean: 1000 mm become 667, then 333, and stay so for one more good reading.
# Hurts:     Anyone who lets a robot wait until the way is free, or stops it at a threshold.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            mr-di-sensors==0.0.3 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >gopigo.py <<'END'
import contextlib
import io
import sys
from unittest.mock import MagicMock

for module in ("di_i2c", "I2C_mutex"):
    sys.modules[module] = MagicMock()  # of the robot

from di_sensors import easy_distance_sensor

easy_distance_sensor.time = MagicMock()
value = None


class Chip:
    """A VL53L0X that reports one value, or fails."""

    def read_range_single_millimeters(self):
        if value is None:
            raise OSError("bus")
        return value


for name, values in (("obstacle goes away", (1000, 1000, 8190, 8190, 8190)), ("bus fails twice", (1000, 1000, None, None, 1000, 1000))):
    sensor = easy_distance_sensor.EasyDistanceSensor.__new__(easy_distance_sensor.EasyDistanceSensor)
    sensor._readings, sensor.use_mutex, sensor.VL53L0X = [], False, Chip()
    seen = []
    for value in values:
        with contextlib.redirect_stdout(io.StringIO()):
            seen.append(sensor.read_mm())
    print(f"{name}: {values} are read as {seen}")
END
venv/bin/python gopigo.py >seen

cat >expected <<'END'
obstacle goes away: (1000, 1000, 8190, 8190, 8190) are read as [1000, 1000, 1000, 1000, 1000]
bus fails twice: (1000, 1000, None, None, 1000, 1000) are read as [1000, 1000, 667, 333, 333, 667]
END
diff expected seen || { echo "CHANGED: di-sensors-nothing-is-the-last" >&2; exit 1; }
echo "PASS: an obstacle that went away is still there"
