#!/bin/sh
# SPDX-License-Identifier: MIT
# A record of Intel HEX that runs over the end of its segment continues at its start or behind it, as the tool likes.
#
# Version:   bincopy 20.1.1, intelhex 2.3.0, srec_cat of srecord 1.64 (Debian 12).
# Expected:  Under a segment address (record 02) offsets are of 16 bits and wrap, as the format is defined: F000:FFFF
#            is followed by F000:0000.
# Behaviour: srec_cat wraps to F0000. intelhex and bincopy go on at 100000.
# Hurts:     Anyone who checks an image with one tool and writes it with another: one byte lies 64 KB apart.
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

printf ':02000002F0000C\n:02FFFF000102FD\n:00000001FF\n' >wrap.hex
cat >read.py <<'END'
import bincopy
import intelhex

file = bincopy.BinFile()
file.add_ihex_file("wrap.hex")
print("bincopy", [(hex(segment.address), segment.data.hex()) for segment in file.segments])
print("intelhex", {hex(address): value for address, value in intelhex.IntelHex("wrap.hex").todict().items()})
END
venv/bin/python read.py >seen
srec_cat wrap.hex -intel -o - -hex-dump 2>/dev/null | awk '{print "srec_cat", $1, $2}' | cut -c1-20 >>seen

cat >expected <<'END'
bincopy [('0xfffff', '0102')]
intelhex {'0xfffff': 1, '0x100000': 2}
srec_cat 000F0000: 0
srec_cat 000FFFF0: 0
END
diff expected seen || { echo "CHANGED: hex-segment-wrap" >&2; exit 1; }
echo "PASS: the second byte is at F0000 in srec_cat, at 100000 in the others"
