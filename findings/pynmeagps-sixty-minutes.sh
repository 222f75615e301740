#!/bin/sh
# SPDX-License-Identifier: MIT
# pynmeagps writes 59.999999999 degrees as 59 degrees and 60 minutes.
#
# Version:   pynmeagps 1.1.8.
# Expected:  A position that rounds up to a whole degree is written as that degree: 6000.00000.
# Behaviour: Degrees are cut off and minutes rounded, each alone: 5960.00000, and 17960.00000 for nearly 180. Strict
#            readers refuse 60 minutes as out of range.
# Hurts:     Anyone who makes NMEA sentences from computed positions, as simulators and bridges do: seldom, and only on
#            lines of whole degrees.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pynmeagps==1.1.8 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >minutes.py <<'END'
from pynmeagps import NMEAMessage

for lat, lon in ((59.5, 0.5), (59.999999999, 179.999999999), (-0.99999999, 0.99999999)):
    sentence = NMEAMessage("GN", "GLL", 0, lat=lat, lon=lon, status="A", posMode="A").serialize().decode()
    print(lat, lon, "is written as", ",".join(sentence.split(",")[1:5]))
END
venv/bin/python minutes.py >seen

cat >expected <<'END'
59.5 0.5 is written as 5930.00000,N,00030.00000,E
59.999999999 179.999999999 is written as 5960.00000,N,17960.00000,E
-0.99999999 0.99999999 is written as 0060.00000,S,00060.00000,E
END
diff expected seen || { echo "CHANGED: pynmeagps-sixty-minutes" >&2; exit 1; }
echo "PASS: 59.999999999 degrees are written as 5960.00000"
