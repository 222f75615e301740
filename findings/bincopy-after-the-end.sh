#!/bin/sh
# SPDX-License-Identifier: MIT
# Of two Intel HEX files in a row, bincopy reads both, intelhex and srec_cat only the first.
#
# Version:   bincopy 20.1.1, intelhex 2.3.0, srec_cat of srecord 1.64 (Debian 12).
# Expected:  The record 01 ends the file: all three stop there, or all refuse what follows.
# Behaviour: bincopy goes on and returns the data of both. The others return the first, srec_cat without a warning.
# Hurts:     Anyone who joins a boot loader and a program with cat: one tool shows both, another writes half of it
#            into flash.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            bincopy==20.1.1 intelhex==2.3.0 || return 1
    apt-get -qq -s install srecord=1.64-3 >plan &&
        sed -n 's/^Inst \([^ ]*\).*/\1/p' plan | xargs -r apt-get -qq download &&
        find . -name '*.deb' -exec dpkg -x {} debian \; || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }
PATH="$PWD/debian/usr/bin:$PWD/debian/usr/sbin:$PATH"
LD_LIBRARY_PATH="$PWD/debian/usr/lib/$(uname -m)-linux-gnu"
export PATH LD_LIBRARY_PATH

cat >both.hex <<'END'
:0100000001FE
:00000001FF
:0100010002FC
:00000001FF
END
cat >read.py <<'END'
import bincopy
import intelhex

both = bincopy.BinFile()
both.add_ihex_file("both.hex")
print("bincopy", both.as_binary().hex())
print("intelhex", intelhex.IntelHex("both.hex").tobinstr().hex())
END
venv/bin/python read.py >seen
echo "srec_cat $(srec_cat both.hex -intel -o - -hex-dump | head -1 | cut -c11-15)" >>seen

cat >expected <<'END'
bincopy 0102
intelhex 01
srec_cat 01   
END
diff expected seen || { echo "CHANGED: bincopy-after-the-end" >&2; exit 1; }
echo "PASS: bincopy reads 01 02, the others 01"
