#!/bin/sh
# SPDX-License-Identifier: MIT
# A signal of sector 0 is in all sectors once canmatrix has written a DBC file to JSON and read it again.
#
# Version:   canmatrix 1.2.
# Expected:  With everything exported, as jsonExportAll asks, each multiplexed signal keeps its sector.
# Behaviour: The number 0 is taken for none: what belongs to multiplexer value 0 becomes a plain signal, the others keep
#            theirs. Without the option all become plain. What was one of two is decoded in each frame.
# Hurts:     Anyone who keeps databases in JSON: readers that check for overlap refuse the file, others show the back as
#            the front.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            canmatrix==1.2 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >ring.dbc <<'END'
VERSION ""
NS_ :
BS_:
BU_: ring
BO_ 256 Range: 8 ring
 SG_ range : 0|16@1+ (0.5,-10) [-10|2000] "cm" ring
 SG_ speed : 16|16@1- (1,0) [-2000|2000] "mm/s" ring
 SG_ level : 32|32@1- (1,0) [0|0] "V" ring
BO_ 257 Sector: 8 ring
 SG_ sector M : 0|8@1+ (1,0) [0|1] "" ring
 SG_ front m0 : 8|16@1+ (1,0) [0|2000] "cm" ring
 SG_ back m1 : 8|16@1+ (1,0) [0|2000] "cm" ring
SIG_VALTYPE_ 256 level : 1;
END
cat >convert.py <<'END'
import canmatrix.formats as formats


def sectors(matrix):
    """Return the multiplexing of each signal of the frame."""
    return {signal.name: signal.multiplex for signal in matrix.frame_by_name("Sector").signals}


matrix = formats.loadp("ring.dbc")[""]
print("seen DBC", sectors(matrix))
for options in ({}, {"jsonExportAll": True}):
    formats.dumpp({"": matrix}, "ring.json", **options)
    print("seen JSON", *options, sectors(list(formats.loadp("ring.json").values())[0]))
END
venv/bin/python convert.py 2>/dev/null | grep '^seen' >seen

cat >expected <<'END'
seen DBC {'sector': 'Multiplexor', 'front': 0, 'back': 1}
seen JSON {'sector': None, 'front': None, 'back': None}
seen JSON jsonExportAll {'sector': 'Multiplexor', 'front': None, 'back': 1}
END
diff expected seen || { echo "CHANGED: canmatrix-json-sector-zero" >&2; exit 1; }
echo "PASS: multiplexer value 0 is lost, 1 is kept"
