#!/bin/sh
# SPDX-License-Identifier: MIT
# Beyond its threshold DIYables_Pico_Ultrasonic_Sensor reports False, which is less than every range.
#
# Version:   DIYables_Pico_Ultrasonic_Sensor 0.1.1.
# Expected:  What is farther than the threshold is None or infinity, or raises where it is compared.
# Behaviour: get_distance returns False. It compares and counts as 0: the far wall is nearer than the near box, and
#            min, mean and a stop below 20 cm take it for a contact.
# Hurts:     Anyone who brakes by a comparison, or takes the nearest of several sensors: the robot stops where the way
#            is free.
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

cat >far.py <<'END'
import sys
import time
import types

now, wall = 0, 0  # microseconds; the range in mm


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
        return int(0 <= now - Pin.fired - 500 < wall / 0.17)


sys.modules["machine"] = types.SimpleNamespace(Pin=Pin)
sys.modules["utime"] = types.SimpleNamespace(ticks_us=lambda: now, ticks_diff=lambda a, b: a - b)
time.sleep_us = lambda duration: None

from DIYables_Pico_Ultrasonic_Sensor import UltrasonicSensor

sensor = UltrasonicSensor(0, 1)
sensor.set_detection_threshold(100)
ranges = []
for wall in (300, 900, 1500):
    sensor.loop()
    ranges.append(sensor.get_distance())
    print(f"wall at {wall // 10} cm: {ranges[-1] if ranges[-1] is False else round(ranges[-1])}, stop below 20 cm: {ranges[-1] < 20}")
print("nearest of the three:", min(ranges))
END
venv/bin/python far.py >seen

cat >expected <<'END'
wall at 30 cm: 30, stop below 20 cm: False
wall at 90 cm: 90, stop below 20 cm: False
wall at 150 cm: False, stop below 20 cm: True
nearest of the three: False
END
diff expected seen || { echo "CHANGED: diyables-far-is-nearest" >&2; exit 1; }
echo "PASS: a wall beyond the threshold is False, and False < 20"
