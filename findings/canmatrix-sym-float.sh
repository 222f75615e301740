#!/bin/sh
# SPDX-License-Identifier: MIT
# A float in a DBC file is an integer in the SYM file that canmatrix makes of it: 1.5 V are read as 1069547520.
#
# Version:   canmatrix 1.2.
# Expected:  The signal is written with the type that the SYM format has for floats. The reader of canmatrix knows it.
# Behaviour: It is written as signed, and is read so by canmatrix itself. A SYM file that says float is read right.
# Hurts:     Anyone who hands a database to people with PCAN tools.
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
 SG_ range : 0|16@1+ (0.5,-10) [0|2000] "cm" ring
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


matrix = formats.loadp("ring.dbc")[""]
formats.dumpp({"": matrix}, "ring.sym")
text = open("ring.sym").read()
print("seen", *(" ".join(line.split()[:3]) for line in text.splitlines() if "level" in line))
open("fixed.sym", "w").write(text.replace("level signed", "level float"))
for file in ("ring.dbc", "ring.sym", "fixed.sym"):
    signal = list(formats.loadp(file).values())[0].frame_by_name("Range").signal_by_name("level")
    raw = list(formats.loadp(file).values())[0].frame_by_name("Range").unpack(bytes.fromhex("c800fbff0000c03f"))
    print("seen", file, "float" if signal.is_float else "integer", raw["level"].raw_value)
END
venv/bin/python convert.py 2>/dev/null | grep '^seen' >seen

cat >expected <<'END'
seen Var=level signed 32,32
seen ring.dbc float 1.5
seen ring.sym integer 1069547520
seen fixed.sym float 1.5
END
diff expected seen || { echo "CHANGED: canmatrix-sym-float" >&2; exit 1; }
echo "PASS: a float of 1.5 is written to SYM as signed"
