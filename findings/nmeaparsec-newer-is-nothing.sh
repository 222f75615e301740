#!/bin/sh
# SPDX-License-Identifier: MIT
# nmeaparsec reads nothing from a receiver that uses more than GPS, or that sends whole seconds: the list is empty.
#
# Version:   nmeaparsec 0.1.0, numpy 2.4.6.
# Expected:  RMC and GGA sentences are read, whichever system their talker names and however many decimals the time
#            has.
# Behaviour: Only lines that start with $GPRMC and $GPGGA count; a receiver with GPS and Galileo sends $GNRMC, and its
#            file gives no point and no message. A time without decimals, 123519, which the standard shows, is an error
#            that is printed for each line, and no point either.
# Hurts:     Anyone who takes an empty list for a recording without a fix.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            nmeaparsec==0.1.0 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >talker.py <<'END'
import contextlib
import io
from functools import reduce
from operator import xor
from pathlib import Path

from nmeaparsec.nmea_parser import NMEAParser


def sentence(text):
    return f"${text}*{reduce(xor, text.encode()):02X}"


for talker, decimals in (("GP", ".00"), ("GN", ".00"), ("GP", "")):
    lines = []
    for second in range(10):
        time, place = f"12351{second}{decimals}", "4807.038,N,01131.000,E"
        lines.append(sentence(f"{talker}RMC,{time},A,{place},2.0,84.4,281126,,,A"))
        lines.append(sentence(f"{talker}GGA,{time},{place},1,08,0.9,545.4,M,46.9,M,,"))
    Path("log.nmea").write_text("\n".join(lines))
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        points = NMEAParser().parse_file("log.nmea")
    print(f"{talker}RMC and {talker}GGA at 12351x{decimals}: {len(points)} of 10 points, {printed.getvalue().count('Error parsing')} errors printed")
END
venv/bin/python talker.py >seen

cat >expected <<'END'
GPRMC and GPGGA at 12351x.00: 10 of 10 points, 0 errors printed
GNRMC and GNGGA at 12351x.00: 0 of 10 points, 0 errors printed
GPRMC and GPGGA at 12351x: 0 of 10 points, 10 errors printed
END
diff expected seen || { echo "CHANGED: nmeaparsec-newer-is-nothing" >&2; exit 1; }
echo "PASS: of a receiver with GN sentences there is no point"
