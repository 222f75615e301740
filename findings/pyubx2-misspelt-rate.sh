#!/bin/sh
# SPDX-License-Identifier: MIT
# A misspelt field of a UBX command is dropped by pyubx2, and the receiver is asked for a period of 0 ms.
#
# Version:   pyubx2 1.4.0.
# Expected:  A name that the message does not have is refused, as a value is that its field cannot hold.
# Behaviour: UBXMessage builds the command with zero in the field that was meant, and says nothing.
# Hurts:     Anyone who sets the rate, the ports or the limits of a receiver from a program: it is told zero, and zero
#            has a meaning of its own in many fields.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pyubx2==1.4.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
from pyubx2 import SET, UBXMessage, UBXReader


def sent(**fields):
    """Build the command and parse it again."""
    return UBXReader.parse(UBXMessage("CFG", "CFG-RATE", SET, **fields).serialize(), msgmode=SET)


print(sent(measRate=100, navRate=1, timeRef=0))
print(sent(measrate=100, navRate=1, timeRef=0))
print(sent(measRate=100, nav_rate=1))
for wrong in (70000, 100.5):
    try:
        print(sent(measRate=wrong))
    except Exception as error:
        print(wrong, "refused,", type(error).__name__)
END

cat >expected <<'END'
<UBX(CFG-RATE, measRate=100, navRate=1, timeRef=0)>
<UBX(CFG-RATE, measRate=0, navRate=1, timeRef=0)>
<UBX(CFG-RATE, measRate=100, navRate=0, timeRef=0)>
70000 refused, UBXTypeError
100.5 refused, UBXTypeError
END
diff expected seen || { echo "CHANGED: pyubx2-misspelt-rate" >&2; exit 1; }
echo "PASS: a misspelt measRate is sent as 0"
