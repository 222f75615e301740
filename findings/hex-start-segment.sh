#!/bin/sh
# SPDX-License-Identifier: MIT
# The start of a program at 1234:3800 in Intel HEX becomes three addresses in three converters.
#
# Version:   bincopy 20.1.1, srec_cat of srecord 1.64, objcopy of binutils 2.40 (Debian 12).
# Expected:  Record 03 holds CS:IP, and 1234:3800 is 12340 + 3800 = 15B40.
# Behaviour: srec_cat writes 15B40. objcopy puts its lower 16 bits, 5B40, into a record S9. bincopy takes the four
#            bytes for one linear address, 12343800, and writes that as Intel HEX, too.
# Hurts:     Anyone who converts an image and lets the loader jump to its start.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            bincopy==20.1.1 || return 1
    apt-get -qq -s install srecord=1.64-3 binutils >plan &&
        sed -n 's/^Inst \([^ ]*\).*/\1/p' plan | xargs -r apt-get -qq download &&
        find . -name '*.deb' -exec dpkg -x {} debian \; || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }
PATH="$PWD/debian/usr/bin:$PWD/debian/usr/sbin:$PATH"
LD_LIBRARY_PATH="$PWD/debian/usr/lib/$(uname -m)-linux-gnu"
export PATH LD_LIBRARY_PATH

printf ':04000003123438007B\n:0100000001FE\n:00000001FF\n' >start.hex
cat >read.py <<'END'
import bincopy

file = bincopy.BinFile()
file.add_ihex_file("start.hex")
print("bincopy ", hex(file.execution_start_address), file.as_ihex().split()[1], file.as_srec().split()[-1])
END
venv/bin/python read.py >seen
echo "srec_cat $(srec_cat start.hex -intel -o - | tail -1)" >>seen
objcopy -I ihex -O srec start.hex start.srec
echo "objcopy  $(tail -1 start.srec | tr -d '\r')" >>seen

cat >expected <<'END'
bincopy  0x12343800 :040000051234380079 S705123438007C
srec_cat S804015B405F
objcopy  S9035B4061
END
diff expected seen || { echo "CHANGED: hex-start-segment" >&2; exit 1; }
echo "PASS: 1234:3800 is 12343800 in bincopy, 15B40 in srec_cat, 5B40 in objcopy"
