#!/bin/sh
# SPDX-License-Identifier: MIT
# pymavlink cuts a ring of 80 ranges in OBSTACLE_DISTANCE to 72 without a word, and leaves the increment as it was.
#
# Version:   pymavlink 2.4.50.
# Expected:  A list that is longer than the message's 72 sectors is refused, as one with a range of 70,000 is.
# Behaviour: The first 72 go out. A ring of 80 sectors of 4.5 degrees then ends 36 degrees before it closes, and nothing
#            in the message tells of it.
# Hurts:     Anyone who sends a ring of other than 72 sectors to an autopilot: it is blind where the list was cut.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pymavlink==2.4.50 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
from pymavlink.dialects.v20 import common


def sent(ranges_cm, degrees):
    """Pack a ring and parse it again."""
    message = common.MAVLink_obstacle_distance_message(0, 1, ranges_cm, 0, 10, 500, increment_f=degrees)
    return common.MAVLink(None).parse_buffer(message.pack(common.MAVLink(None)))[0]


for sectors in (72, 80):
    heard = sent([100 + k for k in range(sectors)], 360 / sectors)
    covered = len(heard.distances) * heard.increment_f
    print(sectors, "sent,", len(heard.distances), "heard, last", heard.distances[-1], f"cm, {covered:g} degrees covered")
try:
    sent([70000] * 72, 5)
except Exception:
    print("70000 refused")
END

cat >expected <<'END'
72 sent, 72 heard, last 171 cm, 360 degrees covered
80 sent, 72 heard, last 171 cm, 324 degrees covered
70000 refused
END
diff expected seen || { echo "CHANGED: mavlink-ring-cut" >&2; exit 1; }
echo "PASS: of a ring of 80 ranges 72 go out"
