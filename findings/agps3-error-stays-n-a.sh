#!/bin/sh
# SPDX-License-Identifier: MIT
# agps3 keeps rms, major, minor and orient of a receiver's error at n/a for ever, and its raw mode asks gpsd by a text
# that is no JSON.
#
# Version:   agps3 0.36.1.
# Expected:  The values of a message GST are attributes by their names, of which lat, lon and alt have sd in front, as
#            positions have these names already. Raw data is asked for as the rare kind is.
# Behaviour: The condition for lat and lon is always true, so all values go to names that begin with sd: sdrms, sdmajor.
#            For raw data "raw",2 is sent instead of "raw":2.
# Hurts:     Anyone who waits for a small error before the robot starts: n/a is no number, and it never changes. Read
#            sdrms.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            agps3==0.36.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >error.py <<'END'
import json

from agps3 import agps3

stream = agps3.DataStream()
stream.unpack('{"class": "GST", "rms": 2.5, "major": 1.5, "minor": 0.5, "orient": 30, "lat": 1.0, "lon": 1.1, "alt": 3.0}')
for name in ("rms", "major", "minor", "orient", "lat"):
    print(f"{name}: {getattr(stream, name)}, sd{name}: {getattr(stream, 'sd' + name)}")
sent = []
gpsd = agps3.GPSDSocket()
gpsd.send = sent.append
for kind in ("json", "rare", "raw"):
    gpsd.watch(gpsd_protocol=kind)
    try:
        found = json.loads(sent[-1].removeprefix("?WATCH="))
    except json.JSONDecodeError:
        found = "no JSON"
    print(f"{kind}: {sent[-1]} is {found}")
END
venv/bin/python error.py >seen

cat >expected <<'END'
rms: n/a, sdrms: 2.5
major: n/a, sdmajor: 1.5
minor: n/a, sdminor: 0.5
orient: n/a, sdorient: 30
lat: n/a, sdlat: 1.0
json: ?WATCH={"enable":true,"json":true} is {'enable': True, 'json': True}
rare: ?WATCH={"enable":true,"raw":1} is {'enable': True, 'raw': 1}
raw: ?WATCH={"enable":true,"raw",2} is no JSON
END
diff expected seen || { echo "CHANGED: agps3-error-stays-n-a" >&2; exit 1; }
echo "PASS: rms is n/a and sdrms is 2.5"
