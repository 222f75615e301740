#!/bin/sh
# SPDX-License-Identifier: MIT
# cantools decode takes an extended frame for the message whose standard identifier has the same number.
#
# Version:   cantools 45.1.0.
# Expected:  candump writes 8 digits for a 29-bit identifier, so 00000123 is another identifier than 123 and the
#            database knows none such.
# Behaviour: Only the number is compared. The frame is decoded as the standard message, without a sign of doubt. The
#            Python API, asked with the extended number of DBC, raises KeyError.
# Hurts:     Anyone who has J1939 or a vendor protocol beside standard frames on one bus: foreign bytes are shown as
#            speeds.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            cantools==45.1.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >bus.dbc <<'END'
VERSION ""
BU_: A
BO_ 291 Speed: 1 A
 SG_ mm : 0|8@1+ (10,0) [0|2550] "" A
END
printf '(1.0) can0 %s#0A\n' 123 00000123 | venv/bin/cantools decode --single-line bus.dbc >seen

cat >expected <<'END'
(1.0) can0 123#0A :: Speed(mm: 100)
(1.0) can0 00000123#0A :: Speed(mm: 100)
END
diff expected seen || { echo "CHANGED: cantools-extended-as-standard" >&2; exit 1; }
echo "PASS: 00000123#0A is decoded as the message with the standard identifier 123"
