#!/bin/sh
# SPDX-License-Identifier: MIT
# Half a degree west is longitude_degrees 0 and longitude_minutes 30 in adafruit_gps, as half a degree east is.
#
# Version:   adafruit-circuitpython-gps 4.0.0.
# Expected:  The pair of whole degrees and minutes, which the library offers for boards with short floating-point
#            numbers, names the same place as longitude does.
# Behaviour: The sign is kept in the degrees alone, and 0 has none: all places within a degree of the equator or of
#            Greenwich are mirrored. Elsewhere -7 and 59.9999 mean -7.999998: the minutes must be subtracted where
#            degrees are negative.
# Hurts:     Anyone who logs or sends the two numbers from a boat or rover, in London as in Accra.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            adafruit-circuitpython-gps==4.0.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >place.py <<'END'
import adafruit_gps


class Port:
    """A serial port that has received one sentence."""

    def __init__(self, sentence):
        check = 0
        for byte in sentence.encode():
            check ^= byte
        self.line = f"${sentence}*{check:02X}\r\n".encode()

    @property
    def in_waiting(self):
        return len(self.line)

    def readline(self):
        line, self.line = self.line, b""
        return line


for place in ("0030.0000,N,00030.0000,E", "0030.0000,S,00030.0000,W", "1230.5000,S,00759.9999,W"):
    gps = adafruit_gps.GPS(Port(f"GNRMC,120000.00,A,{place},000.5,054.7,271126,,,A"))
    gps.update()
    print(
        f"{place}: {gps.latitude:.4f} {gps.longitude:.4f} is {gps.latitude_degrees} and {gps.latitude_minutes},",
        f"{gps.longitude_degrees} and {gps.longitude_minutes}",
    )
END
venv/bin/python place.py >seen

cat >expected <<'END'
0030.0000,N,00030.0000,E: 0.5000 0.5000 is 0 and 30.0, 0 and 30.0
0030.0000,S,00030.0000,W: -0.5000 -0.5000 is 0 and 30.0, 0 and 30.0
1230.5000,S,00759.9999,W: -12.5083 -8.0000 is -12 and 30.5, -7 and 59.9999
END
diff expected seen || { echo "CHANGED: adafruit-gps-west-is-east" >&2; exit 1; }
echo "PASS: half a degree west and half a degree east are 0 and 30.0"
