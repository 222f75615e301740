#!/bin/sh
# SPDX-License-Identifier: MIT
# A DBC file that canmatrix takes to Excel and back has lost its signs, and its offsets are other numbers.
#
# Version:   canmatrix 1.2, with xlrd 2.0.1, xlwt 1.3.0, xlsxwriter 3.2.0, openpyxl 3.1.5.
# Expected:  A database that canmatrix writes to Excel for review and reads again decodes as before.
# Behaviour: No signal is signed or a float any more. In .xls the offset is 0, in .xlsx it is the least value of the
#            signal: an echo at 90 cm is at 100, and a speed of -5 is 65531 or 63531.
# Hurts:     Anyone who lets a table be reviewed or completed in Excel and makes the DBC file of it: the first negative
#            value tells, or none.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            canmatrix==1.2 xlrd==2.0.1 xlwt==1.3.0 xlsxwriter==3.2.0 openpyxl==3.1.5 || return 1
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
for kind in ("dbc", "xls", "xlsx"):
    if kind != "dbc":
        formats.dumpp({"": matrix}, "ring." + kind)
    for signal in list(formats.loadp("ring." + kind).values())[0].frame_by_name("Range").signals:
        sort = "float" if signal.is_float else "signed" if signal.is_signed else "unsigned"
        print("seen", kind, signal.name, sort, f"x {float(signal.factor):g} + {float(signal.offset):g}")
END
venv/bin/python convert.py 2>/dev/null | grep '^seen' >seen

cat >expected <<'END'
seen dbc range unsigned x 0.5 + -10
seen dbc speed signed x 1 + 0
seen dbc level float x 1 + 0
seen xls range unsigned x 0.5 + 0
seen xls speed unsigned x 1 + 0
seen xls level unsigned x 1 + 0
seen xlsx range unsigned x 0.5 + 0
seen xlsx speed unsigned x 1 + -2000
seen xlsx level unsigned x 1 + 0
END
diff expected seen || { echo "CHANGED: canmatrix-excel-signs" >&2; exit 1; }
echo "PASS: no signal is signed after Excel, and offsets are 0 or the least value"
