#!/bin/sh
# SPDX-License-Identifier: MIT
# The battery of alphabot-interface runs down by being asked, and minutes are taken for hours: an idle robot is empty
# after 35 minutes, or sooner if somebody looks.
#
# Version:   alphabot-interface 0.2.5.
# Expected:  At 100 mA a battery of 3500 mAh is at 97 per cent after an hour, however often its state is read.
# Behaviour: The time in a state is kept in minutes and multiplied by the current. Each reading adds the whole time
#            since the last change of the state once more.
# Hurts:     Anyone who returns home at a level, or shows it once a second. Count the hours outside.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            alphabot-interface==0.2.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >battery.py <<'END'
import sys
import time
import types

sys.modules["RPi"] = types.ModuleType("RPi")
sys.modules["RPi"].GPIO = sys.modules["RPi.GPIO"] = types.ModuleType("RPi.GPIO")
clock = {"now": 0.0}
time.time = lambda: clock["now"]
from alphabot import Battery

for minutes, readings in ((60, 1), (20, 1), (20, 2), (20, 20)):
    clock["now"] = 0.0
    battery = Battery()
    for _ in range(readings):
        clock["now"] += 60.0 * minutes / readings
        percent = battery.get_battery_percent()
    print(f"{minutes} minutes idle at 100 mA, read {readings} times: {percent} per cent")
print("by the numbers, after 60 minutes:", round(100 * (1 - 100 / 3500), 2), "per cent")
END
venv/bin/python battery.py >seen

cat >expected <<'END'
60 minutes idle at 100 mA, read 1 times: 0.0 per cent
20 minutes idle at 100 mA, read 1 times: 42.86 per cent
20 minutes idle at 100 mA, read 2 times: 14.29 per cent
20 minutes idle at 100 mA, read 20 times: 0.0 per cent
by the numbers, after 60 minutes: 97.14 per cent
END
diff expected seen || { echo "CHANGED: alphabot-battery-is-asked-empty" >&2; exit 1; }
echo "PASS: an hour of idling empties the battery"
