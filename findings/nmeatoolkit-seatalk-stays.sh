#!/bin/sh
# SPDX-License-Identifier: MIT
# stalk2nmea of nmeatoolkit converts no depth: the sentence comes out as it went in, because the checksum is taken for
# a part of the last number.
#
# Version:   nmeatoolkit 0.2, pynmea2 1.19.0, python-dateutil 2.9.0.post0.
# Expected:  A depth in a $STALK sentence becomes DBT, and the track has every fifth point if that is asked for.
# Behaviour: The sentence is printed with its checksum, split at commas, and the last field, 00*6D, is not a number:
#            the error is swallowed, whether the sentence had a checksum or not. The counter for thinning a track is
#            never raised, so all points stay. A time to cut at without a zone is an error at the first sentence.
# Hurts:     Anyone who bridges an older boat network, or thins a recording.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            nmeatoolkit==0.2 \
            pynmea2==1.19.0 \
            python-dateutil==2.9.0.post0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >seatalk.py <<'END'
from functools import reduce
from operator import xor

import pynmea2
from nmeatoolkit.pipes.crop import CropPipe
from nmeatoolkit.pipes.seatalk import SeatalkPipe
from nmeatoolkit.translators.trackpoint import TrackPointTranslator


def parse(text):
    return pynmea2.parse(f"${text}*{reduce(xor, text.encode()):02X}")


for sentence in (parse("STALK,00,02,00,64,00"), pynmea2.parse("$STALK,00,02,00,64,00")):  # 10 feet
    print(sentence, "becomes", *SeatalkPipe().transform(sentence))
track = TrackPointTranslator(diluition=5)
for second in range(10):
    fix = parse(f"GPRMC,12351{second},A,4807.038,N,01131.000,E,2.0,84.4,281126,,,A")
    track.feed(fix)
print(f"every fifth of 10 points: {len(track.result())}")
try:
    CropPipe(fr="2026-11-28 12:35:15").transform(fix)
except TypeError as error:
    print("cut:", error)
END
venv/bin/python seatalk.py >seen

cat >expected <<'END'
$STALK,00,02,00,64,00*6D becomes $STALK,00,02,00,64,00*6D
$STALK,00,02,00,64,00*6D becomes $STALK,00,02,00,64,00*6D
every fifth of 10 points: 10
cut: can't compare offset-naive and offset-aware datetimes
END
diff expected seen || { echo "CHANGED: nmeatoolkit-seatalk-stays" >&2; exit 1; }
echo "PASS: a depth in Seatalk stays as it is"
