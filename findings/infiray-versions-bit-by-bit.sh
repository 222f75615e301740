#!/bin/sh
# SPDX-License-Identifier: MIT
# infiray_lrf reads each half of a version byte with its bits in reverse: 1.2 is 8.4, a date in March is in December,
# and one in July raises.
#
# Version:   infiray-lrf 1.0.1, construct 2.10.70, pyserial 3.5.
# Expected:  The two digits of a byte are its two halves, in one order or the other.
# Behaviour: construct is told to swap the bits of the byte, so that single bits count from the low end. That is right
#            for flags, and turns numbers of four bits round: 1 is 8, 3 is 12. Counters of 24 bits have no name in the
#            description and are dropped.
# Hurts:     Anyone who looks up whether a laser has the firmware that a bulletin is about, or how many pulses it has
#            sent.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            infiray-lrf==1.0.1 \
            construct==2.10.70 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >version.py <<'END'
from infiray_lrf.commands import command_response_struct


def answer(command, parameters):
    """A message of the laser."""
    body = bytes([0x03, command]) + parameters
    return b"\xee\x16" + bytes([len(body)]) + body + bytes([sum(body) & 255])


for month in (1, 3, 7, 12):
    # version 1.2, day 24, year 2021 in the upper half and the month in the lower, author 0x00
    message = answer(0xA7, bytes([0x12, 24, 0x10 | month, 0]))
    try:
        seen = command_response_struct.parse(message).params
        print(f"1.2 of 2021-{month:02}-24:", seen.ver, "of", seen.date)
    except ValueError as error:
        print(f"1.2 of 2021-{month:02}-24: ValueError,", error)
total = command_response_struct.parse(answer(0x90, (123456).to_bytes(3, "big"))).params
print("123456 pulses:", {name: value for name, value in total.items() if name != "_io"})
END
venv/bin/python version.py >seen

cat >expected <<'END'
1.2 of 2021-01-24: 8.4 of 2028-08-24
1.2 of 2021-03-24: 8.4 of 2028-12-24
1.2 of 2021-07-24: ValueError, month must be in 1..12
1.2 of 2021-12-24: 8.4 of 2028-03-24
123456 pulses: {}
END
diff expected seen || { echo "CHANGED: infiray-versions-bit-by-bit" >&2; exit 1; }
echo "PASS: version 1.2 is 8.4, and the count is dropped"
