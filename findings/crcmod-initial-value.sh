#!/bin/sh
# SPDX-License-Identifier: MIT
# The initial value of a CRC in crcmod is the one after the final XOR, so a specification typed in gives another CRC.
#
# Version:   crcmod 1.7.
# Expected:  CRC-16/GSM has the register start at 0000 and its result XORed with ffff: initCrc=0, xorOut=0xffff gives
#            its check value ce3c.
# Behaviour: It gives d64e, the check value of CRC-16/GENIBUS, whose register starts at ffff. For GSM initCrc is to be
#            ffff.
# Hurts:     Anyone who copies init and xorout of a data sheet: both orders run, and the wrong one is a CRC that
#            exists.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            crcmod==1.7 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
import crcmod

for start in (0, 0xFFFF):
    print(f"initCrc={start:04x}", hex(crcmod.mkCrcFun(0x11021, initCrc=start, xorOut=0xFFFF, rev=False)(b"123456789")))
END

cat >expected <<'END'
initCrc=0000 0xd64e
initCrc=ffff 0xce3c
END
diff expected seen || { echo "CHANGED: crcmod-initial-value" >&2; exit 1; }
echo "PASS: initCrc=0, xorOut=ffff is d64e (GENIBUS), not ce3c (GSM)"
