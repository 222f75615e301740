#!/bin/sh
# SPDX-License-Identifier: MIT
# dji-drone-data has no flights south of the equator, west of Greenwich or below the place of the start: such lines are
# passed over without a word.
#
# Version:   dji-drone-data 0.1.0, filterpy 1.4.5, numpy 2.2.6.
# Expected:  A latitude of -33.8 is -33.8, and a drone that flies down a valley has a height of -4.2.
# Behaviour: Coordinates and heights are looked for as digits and dots. A line with a minus sign in one of them is no
#            line, so a flight in Sydney or New York is an empty list, and one down a slope lacks its lower part.
# Hurts:     Anyone who maps flights: the distance jumps over the missing part, in a straight line. Count the lines
#            "SrtCnt" and compare.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            dji-drone-data==0.1.0 \
            filterpy==1.4.5 \
            numpy==2.2.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >flight.py <<'END'
from dji_drone_data import DJIDroneDataParser

LINE = """\
{n}
00:00:0{n},000 --> 00:00:0{n},033
<font size="28">SrtCnt : {n}, DiffTime : 33ms
2024-05-01 10:00:0{n}.000
[iso : 100] [shutter : 1/500.0] [fnum : 280] [ev : 0] [ct : 5500] [color_md : default] [focal_len : 240] \
[dzoom_ratio: 10000, delta:0],[latitude: {lat}] [longitude: {lon}] [rel_alt: {height} abs_alt: 50.0] </font>

"""
PLACES = {"Berlin": (52.5, 13.4, 10.0), "Sydney": (-33.8, 151.2, 10.0), "New York": (40.7, -74.0, 10.0)}
PLACES["Berlin, below the start"] = (52.5, 13.4, -4.2)
for n, (name, (lat, lon, height)) in enumerate(PLACES.items()):
    entries = DJIDroneDataParser().parse(LINE.format(n=n, lat=lat, lon=lon, height=height))
    print(f"{name}: {[(entry['latitude'], entry['longitude'], entry['rel_altitude']) for entry in entries]}")
END
venv/bin/python flight.py >seen

cat >expected <<'END'
Berlin: [(52.5, 13.4, 10.0)]
Sydney: []
New York: []
Berlin, below the start: []
END
diff expected seen || { echo "CHANGED: dji-drone-data-no-flights-in-the-south" >&2; exit 1; }
echo "PASS: of four places one is read"
