#!/bin/sh
# SPDX-License-Identifier: MIT
# sonarlight looks for the bottom as many metres too deep as its ping begins below the boat: at 2 m to 12 m and a depth
# of 7 m it takes the echo of 9 m.
#
# Version:   sonarlight 0.1.7, pandas 2.2.3, numpy 1.26.4.
# Expected:  In a ping that shows 2 m to 12 m in 100 samples, a bottom at 7 m is at sample 50.
# Behaviour: It is at sample 70, since the start of the range is subtracted from the span and not from the depth.
#            water() then reaches into the ground, bottom() begins two metres below it, and a bottom in the last metres
#            raises IndexError in bottom_intensity().
# Hurts:     Anyone who classifies the ground by its echo, with a range that does not begin at the surface, as plotters
#            choose it in deep water. The echo at the bottom is frames[int(n * (depth - min_range) / (max_range -
#            min_range))].
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            sonarlight==0.1.7 \
            pandas==2.2.3 \
            numpy==1.26.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >bottom.py <<'END'
import struct

from sonarlight import Sonar

FEET = 3.2808399


def recording(begin, end, depth):
    """Return an SL2 file of three pings, whose sample of each range is that range in decimetres; metres."""
    echo = bytes(int(10 * begin + (end - begin) * i / 10) for i in range(100))
    out = struct.pack("<HHHH", 2, 1, 3200, 0)
    for number in range(3):
        head = bytearray(144)
        struct.pack_into("<I", head, 0, len(out))
        struct.pack_into("<HHHHI", head, 28, 244, 244, 0, len(echo), number)
        struct.pack_into("<ff", head, 40, begin * FEET, end * FEET)
        struct.pack_into("<I", head, 60, 1700000000)
        struct.pack_into("<f", head, 64, depth * FEET)
        out += bytes(head) + echo
    return out


for begin, end, depth in ((0, 10, 7), (2, 12, 7), (2, 12, 11)):
    open("lake.sl2", "wb").write(recording(begin, end, depth))
    sonar = Sonar("lake.sl2")
    print(f"{begin} m to {end} m, bottom at {depth} m:")
    for name in ("bottom_intensity", "bottom"):
        try:
            first = getattr(sonar, name)("primary").ravel()
            print(f"  {name} begins with the echo of", first[0] / 10 if len(first) else "nothing")
        except IndexError as error:
            print(f"  {name}: IndexError")
END
venv/bin/python bottom.py >seen

cat >expected <<'END'
0 m to 10 m, bottom at 7 m:
  bottom_intensity begins with the echo of 7.0
  bottom begins with the echo of 7.0
2 m to 12 m, bottom at 7 m:
  bottom_intensity begins with the echo of 9.0
  bottom begins with the echo of 9.0
2 m to 12 m, bottom at 11 m:
  bottom_intensity: IndexError
  bottom begins with the echo of nothing
END
diff expected seen || { echo "CHANGED: sonarlight-bottom-below-the-range" >&2; exit 1; }
echo "PASS: the echo of 9 m is taken for the bottom at 7 m"
