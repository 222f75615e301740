#!/bin/sh
# SPDX-License-Identifier: MIT
# The address of a robot that was reported yesterday is less than 1 minute old in minirobots_turtle, and one given by
# hand in Tokyo 15 hours.
#
# Version:   minirobots_turtle 0.2.9, requests 2.32.5.
# Expected:  ip_age tells how long ago the robot has reported its address, which tells whether the address may have
#            passed to another device. One that is given by hand is new.
# Behaviour: Whole days are left out: after 24 hours the age starts at less than 1 minute again, after 25 it is 1 hour.
#            The time of an address that is given by hand is local, and compared with UTC: west of Greenwich it is as
#            many hours old as the zone is behind, east of it 24 less than that. Distances and angles are cut to whole
#            millimetres and degrees, so four turns of 0.9 are none.
# Hurts:     Anyone who lets a classroom of robots be found by their code. Look at what the robot itself answers.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            minirobots_turtle==0.2.9 \
            requests==2.32.5 \
            charset-normalizer==3.4.4 \
            idna==3.11 \
            urllib3==2.5.0 \
            certifi==2025.10.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >age.py <<'END'
import os
import time
from datetime import datetime, timedelta, timezone

from minirobots import turtle

for hours in (0, 1, 23, 24, 25, 240):
    reported = datetime.now(timezone.utc) - timedelta(hours=hours, seconds=5)
    print(f"reported {hours} hours ago: {turtle.IP('192.0.2.1', reported.strftime(turtle.DATETIME_FORMAT)).age}")

sent = []
turtle.API.get_robot_status = staticmethod(lambda address: {"debug": False})
turtle.API.send_program_to_robot = staticmethod(lambda address, program: sent.append(program))
for zone in ("UTC", "America/Bogota", "Asia/Tokyo"):
    os.environ["TZ"] = zone
    time.tzset()
    robot = turtle.Turtle("15354b", ip="192.0.2.1")
    print(f"given by hand, {zone}: {robot.ip_age}")
sent.clear()
robot.right(0.9)
print("right(0.9):", [command for command in str(sent).split("'") if command == "RT"], "0" if "0]" in str(sent) else "not 0")
END
venv/bin/python age.py >seen

cat >expected <<'END'
reported 0 hours ago: less than 1 minute
reported 1 hours ago: 1 hour ago
reported 23 hours ago: 23 hours ago
reported 24 hours ago: less than 1 minute
reported 25 hours ago: 1 hour ago
reported 240 hours ago: less than 1 minute
given by hand, UTC: less than 1 minute
given by hand, America/Bogota: 5 hours ago
given by hand, Asia/Tokyo: 15 hours ago
right(0.9): ['RT'] 0
END
diff expected seen || { echo "CHANGED: minirobots-turtle-a-day-is-a-minute" >&2; exit 1; }
echo "PASS: after a day the age starts at less than 1 minute again"
