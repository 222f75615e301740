#!/bin/sh
# SPDX-License-Identifier: MIT
# Piya.Sonar that is told to measure up to 5 m measures up to 3.36 m, since it waits for the time of one way; a ring
# goes on with the last range instead.
#
# Version:   Piya.Sonar 0.1.1, numpy 1.26.4.
# Expected:  max_distance=5 waits for the echo of a wall at 5 m, which takes 29 ms.
# Behaviour: The time-out is the distance divided by the speed of sound, and 5 ms. The echo needs twice that. Beyond it
#            there is no reading, and no callback says so: the ring of Echos goes on with the last range of that
#            sensor.
# Hurts:     Anyone who sets the range that is needed: a wall between 3.3 and 5 m is not there, or is where something
#            else was.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            Piya.Sonar==0.1.1 \
            numpy==1.26.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >sonar.py <<'END'
import sys
from unittest.mock import MagicMock

SPEED = 343


class Pins(MagicMock):
    """A sonar at a wall, with a clock that ticks when it is read."""

    now = trigger = wall = 0.0

    def clock(self):
        self.now += 2e-5
        return self.now

    def input(self, pin):
        return self.trigger + 5e-4 <= self.now < self.trigger + 5e-4 + 2 * self.wall / SPEED

    def output(self, pin, high):
        self.trigger = self.now


pins = Pins()
sys.modules["Jetson"] = MagicMock(GPIO=pins)
sys.modules["Jetson.GPIO"] = pins

from Piya.Sonar import IOEvent as module
from Piya.Sonar.Echo import Echo
from Piya.Sonar.Echos import Echos

module.monotonic = pins.clock
for limit in (2, 5):
    seen = []
    sonar = Echo(1, 2, max_distance=limit, callback=lambda range: seen.append(float(range[0])))
    for pins.wall in (1, 1.8, 1.9, 3.3, 3.4, 4.5):
        pins.now += 1
        seen.clear()
        sonar.send()
        print(f"max_distance {limit}, wall at {pins.wall} m:", ", ".join(f"{one / 100:.1f} m" for one in seen) or "nothing")
    sonar.stop()
ring = Echos({"front": (1, 2)}, callback=lambda ranges: print("ring:", {name: round(float(one)) for name, one in ranges.items()}))
for pins.wall in (1, 4.5):
    pins.now += 1
    ring.send()
    ring.results()
ring.stop()
END
venv/bin/python sonar.py >seen

cat >expected <<'END'
max_distance 2, wall at 1 m: 1.0 m
max_distance 2, wall at 1.8 m: 1.8 m
max_distance 2, wall at 1.9 m: nothing
max_distance 2, wall at 3.3 m: nothing
max_distance 2, wall at 3.4 m: nothing
max_distance 2, wall at 4.5 m: nothing
max_distance 5, wall at 1 m: 1.0 m
max_distance 5, wall at 1.8 m: 1.8 m
max_distance 5, wall at 1.9 m: 1.9 m
max_distance 5, wall at 3.3 m: 3.3 m
max_distance 5, wall at 3.4 m: nothing
max_distance 5, wall at 4.5 m: nothing
Init front trigger pin[1], echo pin[2]
start: front
ring: {'front': 100}
ring: {'front': 100}
END
diff expected seen || { echo "CHANGED: piya-sonar-half-of-the-range" >&2; exit 1; }
echo "PASS: with max_distance 5 there is nothing at 3.6 m"
