#!/bin/sh
# SPDX-License-Identifier: MIT
# An NMEA sentence in a file of a side-scan sonar is read by pyjsf as the decimal digits of one huge number.
#
# Version:   pyjsf 0.0.1, numpy 2.4.6.
# Expected:  The sentence is text, or at least its bytes: $SDDPT,2.4,0.3*5D.
# Behaviour: All bytes of the sentence are taken as one signed number of 140 bits or more, and an array of the digits
#            of that number in decimal is returned. No digit belongs to a character any more. One gets the sentence by
#            putting the digits together and asking for the bytes of the number.
# Hurts:     Anyone who needs the depth, the position or the heading that was recorded beside the pings.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            pyjsf==0.0.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >sentence.py <<'END'
import struct
from pathlib import Path

from pyjsf.jsf_io import jsf_read

sentence = b"$SDDPT,2.4,0.3*5D"
data = struct.pack("<iiB3x", 1764000000, 0, 1) + sentence
header = struct.pack("<HBBHBBBBHi", 0x1601, 8, 0, 2002, 0, 100, 0, 0, 0, len(data))
Path("line.jsf").write_bytes(header + data)
((_, message),) = jsf_read("line.jsf")
digits = message.nmea_string
print(f"{sentence.decode()}: {len(digits)} numbers from {min(digits)} to {max(digits)}, the first", *digits[:12].tolist())
print("put together again:", int("".join(map(str, digits))).to_bytes(len(sentence), "little").decode())
END
venv/bin/python sentence.py >seen

cat >expected <<'END'
$SDDPT,2.4,0.3*5D: 41 numbers from 0 to 9, the first 2 3 2 0 9 8 6 9 1 4 8 9
put together again: $SDDPT,2.4,0.3*5D
END
diff expected seen || { echo "CHANGED: pyjsf-sentence-is-digits" >&2; exit 1; }
echo "PASS: a sentence is an array of decimal digits"
