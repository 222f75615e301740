#!/bin/sh
# SPDX-License-Identifier: MIT
# The 16-bit checksum of crccheck leaves out the last byte of a message with an odd number of bytes.
#
# Version:   crccheck 1.3.1.
# Expected:  A byte too few for a word is padded with zero (as TCP and ARCOS do), or refused.
# Behaviour: It is not summed at all: b"\x01\x02" and b"\x01\x02\x03" have one sum. The 32-bit sum of three bytes is
#            0, and so is its XOR.
# Hurts:     Anyone who checks packets of a robot with it: damage in the last byte of every other packet is not seen.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            crccheck==1.3.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
from crccheck.checksum import Checksum16, Checksum32, ChecksumXor16

for kind in (Checksum16, ChecksumXor16, Checksum32):
    print(kind.__name__, *(hex(kind.calc(bytes(range(1, length + 1)))) for length in (2, 3, 4, 5)))
END

cat >expected <<'END'
Checksum16 0x102 0x102 0x406 0x406
ChecksumXor16 0x102 0x102 0x206 0x206
Checksum32 0x0 0x0 0x1020304 0x1020304
END
diff expected seen || { echo "CHANGED: crccheck-odd-byte" >&2; exit 1; }
echo "PASS: 01 02 and 01 02 03 both have the sum 0x102"
