#!/bin/sh
# SPDX-License-Identifier: MIT
# The C module of bitstruct ignores the byte order that the Python module obeys.
#
# Version:   bitstruct 8.24.0, its C module.
# Expected:  bitstruct.c is the faster twin: it does the same, or raises NotImplementedError, as it does for widths
#            that it lacks.
# Behaviour: The mark for least significant byte first at the end of a format is read and dropped: 1234 is packed
#            big-endian.
# Hurts:     Anyone who swaps the import for speed: each field of two bytes is turned round, without an error.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            bitstruct==8.24.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
import bitstruct
import bitstruct.c

for module in (bitstruct, bitstruct.c):
    print(module.__name__, module.pack("u16<", 0x1234).hex(), hex(module.unpack("u16<", bytes([0x12, 0x34]))[0]))
try:
    bitstruct.c.pack("r12", b"ab")
except NotImplementedError as error:
    print(error)
END

cat >expected <<'END'
bitstruct 3412 0x3412
bitstruct.c 1234 0x1234
Raw not multiple of 8 bits.
END
diff expected seen || { echo "CHANGED: bitstruct-c-byte-order" >&2; exit 1; }
echo "PASS: u16< packs 1234 as 34 12 in Python and as 12 34 in C"
