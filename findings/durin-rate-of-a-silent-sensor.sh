#!/bin/sh
# SPDX-License-Identifier: MIT
# The rate that durin reports for a sensor is 0.00000003 Hz until 50 messages have come, and stays at that of the last
# 50 when the sensor falls silent.
#
# Version:   durin 0.0.84, pycapnp 2.2.4, numpy 2.4.6.
# Expected:  A sensor that sends ten times a second has a rate of 10 Hz, and one that stopped a minute ago has 0.
# Behaviour: The times are kept in a ring of 50 that starts as zeros: the oldest of them is 1970. Later 50 messages are
#            divided by 49 intervals: 10.2 Hz. Nothing lowers the rate when no message comes. Before the first one it
#            is None. Each observation that was kept has become the latest one by then, since all of them share one
#            memory.
# Hurts:     Anyone who watches by these rates whether a sensor is alive, or records observations in a list.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            durin==0.0.84 \
            pycapnp==2.2.4 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >rate.py <<'END'
import multiprocessing
import sys
from types import SimpleNamespace
from unittest.mock import MagicMock

for module in ("pygame", "inputs", "usb", "usb.core"):
    sys.modules[module] = MagicMock()  # for the gamepad and the camera

import durin.sensor
from durin.io import schema

now = 1.7e9
durin.sensor.time = SimpleNamespace(time=lambda: now)
context = multiprocessing.get_context("spawn")
sensor = durin.sensor.DurinSensor(SimpleNamespace(buffer=context.Queue()))
names = "tof tof_status tof_ringbuffer tof_ringbuffer_idx charge voltage status_ringbuffer status_ringbuffer_idx imu imu_ringbuffer imu_ringbuffer_idx uwb uwb_ringbuffer uwb_ringbuffer_idx position"
memory = [getattr(sensor, name) for name in names.split()]
print("no message:", sensor.read().tof_frequency)
kept = {}
for count in range(1, 61):
    message = schema.DurinBase.new_message()
    observation = message.init("tofObservations").init("observations", 1)[0]
    observation.id, observation.ranges = 0, [1000 + count] * 64
    sensor.consume(message, *memory)
    kept[count] = sensor.read()
    if count in (1, 49, 50, 60):
        print(f"{count} messages at 10 Hz: {kept[count].tof_frequency:.8f} Hz, {kept[count].tof[0, 0, 0]:.0f} mm")
    now += 0.1
now += 60
print(f"silent for a minute: {sensor.read().tof_frequency:.1f} Hz")
print(f"the first observation, looked at again: {kept[1].tof[0, 0, 0]:.0f} mm")
END
venv/bin/python rate.py >seen

cat >expected <<'END'
no message: None
1 messages at 10 Hz: 0.00000003 Hz, 1001 mm
49 messages at 10 Hz: 0.00000003 Hz, 1049 mm
50 messages at 10 Hz: 10.20409136 Hz, 1050 mm
60 messages at 10 Hz: 10.20409136 Hz, 1060 mm
silent for a minute: 10.2 Hz
the first observation, looked at again: 1060 mm
END
diff expected seen || { echo "CHANGED: durin-rate-of-a-silent-sensor" >&2; exit 1; }
echo "PASS: 0.00000003 Hz for 49 messages, and 10.2 Hz a minute after the last"
