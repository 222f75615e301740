#!/bin/sh
# SPDX-License-Identifier: MIT
# Each fix of a receiver that sends RMC before GGA gets the time of the next in gpsbabel, the first has no height and
# the last is lost.
#
# Version:   gpsbabel 1.8.0 (Debian 12).
# Expected:  RMC, VTG and GGA with one time are one fix at that time, in whatever order they come.
# Behaviour: A later time in RMC closes the fix before it, but it is closed with the new time: at 12:00:01 the receiver
#           is where it was at 12:00:00. With GGA first all is right. The sentences are the same.
# Hurts:     Anyone who converts a log of a receiver with that order: at 15 m/s and one fix a second the track is 15 m
#           behind the other sensors. Sort GGA before RMC.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    apt-get -qq -s install --no-install-recommends gpsbabel=1.8.0+ds-5 >plan &&
        sed -n 's/^Inst \([^ ]*\).*/\1/p' plan | xargs -r apt-get -qq download &&
        find . -name '*.deb' -exec dpkg -x {} debian \; || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }
libraries=$(find "$PWD/debian" -name '*.so*' -printf '%h\n' | sort -u | paste -sd:)
run() {
    program=$1
    shift
    LD_LIBRARY_PATH="$libraries" "$folder/debian/usr/bin/$program" "$@"
}

cat >log.py <<'END'
import functools
import operator
import sys

for number in range(4):
    time = f"12000{number}.00"
    place = f"480{number}.000,N,01131.000,E"
    sentences = {
        "RMC": f"GPRMC,{time},A,{place},1.0,90.0,141123,,,A",
        "VTG": "GPVTG,90.0,T,,M,1.0,N,1.9,K,A",
        "GGA": f"GPGGA,{time},{place},1,08,0.9,100.0,M,46.9,M,,",
        "GSA": "GPGSA,A,3,01,02,03,04,,,,,,,,,1.8,0.9,1.5",
    }
    for name in sys.argv[1:]:
        body = sentences[name]
        print(f"${body}*{functools.reduce(operator.xor, body.encode()):02X}", end="\r\n")
END
for order in "GGA RMC" "RMC GGA" "RMC VTG GGA GSA" "GGA GSA RMC VTG"; do
    python3 log.py $order >log.nmea
    echo "$order"
    run gpsbabel -t -i nmea -f log.nmea -o unicsv,utc=0 -F track.csv
    python3 -c '
import csv
for row in csv.DictReader(open("track.csv")):
    minutes = (float(row["Latitude"]) - 48) * 60
    height = row["Altitude"] or "unknown"
    print("  %s: minute %.0f, height %s" % (row["Time"], minutes, height))
'
done >seen

cat >expected <<'END'
GGA RMC
  12:00:00: minute 0, height 100.0
  12:00:01: minute 1, height 100.0
  12:00:02: minute 2, height 100.0
  12:00:03: minute 3, height 100.0
RMC GGA
  12:00:00: minute 0, height unknown
  12:00:01: minute 0, height 100.0
  12:00:02: minute 1, height 100.0
  12:00:03: minute 2, height 100.0
RMC VTG GGA GSA
  12:00:00: minute 0, height unknown
  12:00:01: minute 0, height 100.0
  12:00:02: minute 1, height 100.0
  12:00:03: minute 2, height 100.0
GGA GSA RMC VTG
  12:00:00: minute 0, height 100.0
  12:00:01: minute 1, height 100.0
  12:00:02: minute 2, height 100.0
  12:00:03: minute 3, height 100.0
END
diff expected seen || { echo "CHANGED: gpsbabel-one-fix-late" >&2; exit 1; }
echo "PASS: at 12:00:01 the receiver is where it was at 12:00:00"
