#!/bin/sh
# SPDX-License-Identifier: MIT
# pyultrasonic measures once: getDistance and the water level stay at the first reading.
#
# Version:   pyultrasonic 0.1.2.
# Expected:  Each call of getDistance measures.
# Behaviour: It measures where nothing was measured before, and returns the kept number from then on. Only
#            retrieveDistance measures again, and it returns nothing.
# Hurts:     Anyone who polls it in a loop: the obstacle neither comes nor goes, and the pit never fills.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pyultrasonic==0.1.2 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >once.py <<'END'
import sys
import time
import types

now, wall, fired = 0.0, 0.0, 0.0  # seconds; metres


class Pins(types.ModuleType):
    """The pins of a Raspberry Pi with an ultrasonic sensor: the echo is high from 0.5 ms after the trigger on."""

    BCM = OUT = IN = 0

    def setmode(self, mode):
        pass

    def setup(self, pin, direction):
        pass

    def output(self, pin, on):
        global fired
        fired = now

    def input(self, pin):
        global now
        now += 1e-6
        return int(0 <= now - fired - 0.0005 < wall * 2 / 343)

    def cleanup(self):
        pass


sys.modules["RPi"] = types.ModuleType("RPi")
sys.modules["RPi"].GPIO = sys.modules["RPi.GPIO"] = Pins("RPi.GPIO")
time.perf_counter = time.time = lambda: now

from pyultrasonic.sensor import UltrasonicSensorModule

sensor = UltrasonicSensorModule(23, 24, depth=100)
for wall in (0.80, 0.40, 0.10):
    print(f"surface at {wall * 100:.0f} cm: {sensor.getDistance():.0f} cm, level {sensor.waterLevel():.0f} cm, {sensor.waterLevelPercent():.0f} %")
sensor.retrieveDistance()
print(f"after retrieveDistance: {sensor.getDistance():.0f} cm, level {sensor.waterLevel():.0f} cm")
END
venv/bin/python once.py >seen

cat >expected <<'END'
surface at 80 cm: 80 cm, level 20 cm, 20 %
surface at 40 cm: 80 cm, level 20 cm, 20 %
surface at 10 cm: 80 cm, level 20 cm, 20 %
after retrieveDistance: 10 cm, level 90 cm
END
diff expected seen || { echo "CHANGED: pyultrasonic-measures-once" >&2; exit 1; }
echo "PASS: 80 cm are reported when the surface has come to 10 cm"
