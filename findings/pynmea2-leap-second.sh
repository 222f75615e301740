#!/bin/sh
# SPDX-License-Identifier: MIT
# The timestamp of an NMEA sentence is a text, not a time, during a leap second.
#
# Version:   pynmea2 1.19.0.
# Expected:  235960 (a leap second, valid in NMEA 0183) is a time near midnight, or an error.
# Behaviour: pynmea2 hands out the field as the string "235960.00" where all other sentences have a datetime.time.
# Hurts:     Anyone who logs or compares the time of fixes: a TypeError far from its cause, at a moment that no test
#            has.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pynmea2==1.19.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
import pynmea2

for time in ("235959.00", "235960.00"):
    sentence = f"GPGGA,{time},4807.038,N,01131.000,E,1,04,2.6,100.00,M,-33.9,M,,0000"
    check = 0
    for character in sentence:
        check ^= ord(character)
    stamp = pynmea2.parse(f"${sentence}*{check:02X}", check=True).timestamp
    print(type(stamp).__name__, stamp)
END

cat >expected <<'END'
time 23:59:59+00:00
str 235960.00
END
diff expected seen || { echo "CHANGED: pynmea2-leap-second" >&2; exit 1; }
echo "PASS: the timestamp of 235960.00 is of the type str"
