#!/bin/sh
# SPDX-License-Identifier: MIT
# DIYables_Pico_Ultrasonic_Sensor goes on reporting the last obstacle after it has gone, for as long as no echo comes.
#
# Version:   DIYables_Pico_Ultrasonic_Sensor 0.1.1.
# Expected:  Without an echo get_distance is None, as it is before the first one.
# Behaviour: A measurement that times out leaves the list of ranges as it was, with the filter and without, and
#            get_distance takes the newest or the middle of it.
# Hurts:     Anyone whose robot waits for the way to be free: the obstacle that left stays until another one is seen.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            DIYables_Pico_Ultrasonic_Sensor==0.1.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >gone.py <<'END'
import sys
import time
import types

now, wall = 0, None  # microseconds; the range in mm, None for no echo


class Pin:
    """A pin of a Pico with an ultrasonic sensor: the echo is high from 500 us after the trigger on."""

    OUT, IN = 1, 0
    fired = 0

    def __init__(self, number, direction):
        pass

    def low(self):
        Pin.fired = now

    def high(self):
        pass

    def value(self):
        global now
        now += 10
        since = now - Pin.fired - 500
        return int(wall is not None and 0 <= since < wall / 0.17)


sys.modules["machine"] = types.SimpleNamespace(Pin=Pin)
sys.modules["utime"] = types.SimpleNamespace(ticks_us=lambda: now, ticks_diff=lambda a, b: a - b)
time.sleep_us = lambda duration: None

from DIYables_Pico_Ultrasonic_Sensor import UltrasonicSensor

for samples in (1, 5):
    sensor = UltrasonicSensor(0, 1)
    if samples > 1:
        sensor.enable_filter(samples)
    wall = None
    sensor.loop()
    seen = [sensor.get_distance()]
    for wall, times in ((300, 6), (None, 100)):
        for _ in range(times):
            sensor.loop()
        seen.append(f"{sensor.get_distance():.0f} cm")
    print(f"{samples} samples: no echo {seen[0]}, box at 30 cm {seen[1]}, 100 times no echo {seen[2]}")
END
venv/bin/python gone.py >seen

cat >expected <<'END'
1 samples: no echo None, box at 30 cm 30 cm, 100 times no echo 30 cm
5 samples: no echo None, box at 30 cm 30 cm, 100 times no echo 30 cm
END
diff expected seen || { echo "CHANGED: diyables-last-echo-stays" >&2; exit 1; }
echo "PASS: a box at 30 cm is still there after 100 measurements without an echo"
