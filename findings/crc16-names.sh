#!/bin/sh
# SPDX-License-Identifier: MIT
# "CRC-16" and "CRC-16-CCITT" are two algorithms each, depending on the package that is asked.
#
# Version:   crccheck 1.3.1, crcmod 1.7 (Python), crc 4.3.2 (Node).
# Expected:  One name has one meaning, at least where a package on one side of a link talks to one on the other.
# Behaviour: CRC-16 is XMODEM (31c3) in crccheck and ARC (bb3d) in crcmod and Node. CCITT is KERMIT (2189) in
#            crccheck, and IBM-3740 (29b1) in Node.
# Hurts:     Anyone who writes both ends of a serial link by the name, one in Python and one in JavaScript.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            crccheck==1.3.1 crcmod==1.7 || return 1
    npm install --silent --no-fund --no-audit --ignore-scripts \
        crc@4.3.2 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >names.py <<'END'
import crccheck.crc
import crcmod.predefined

CHECK = b"123456789"
print("crccheck Crc16", hex(crccheck.crc.Crc16.calc(CHECK)))
print("crcmod crc-16", hex(crcmod.predefined.mkPredefinedCrcFun("crc-16")(CHECK)))
print("crccheck Crc16Ccitt", hex(crccheck.crc.Crc16Ccitt.calc(CHECK)))
END
cat >names.mjs <<'END'
import crc from "crc";

console.log("node crc16", crc.crc16("123456789").toString(16));
console.log("node crc16ccitt", crc.crc16ccitt("123456789").toString(16));
END
venv/bin/python names.py >seen
node names.mjs >>seen

cat >expected <<'END'
crccheck Crc16 0x31c3
crcmod crc-16 0xbb3d
crccheck Crc16Ccitt 0x2189
node crc16 bb3d
node crc16ccitt 29b1
END
diff expected seen || { echo "CHANGED: crc16-names" >&2; exit 1; }
echo "PASS: CRC-16 is 31c3 or bb3d, CCITT is 2189 or 29b1"
