#!/bin/sh
# SPDX-License-Identifier: MIT
# A stray byte 0x42 before a message of the Ping protocol costs the parser that whole message, and it counts no error.
#
# Version:   bluerobotics-ping 0.2.5.
# Expected:  The parser of Blue Robotics looks for the pair 0x42 0x52, so a stray 0x42 costs one byte.
# Behaviour: After 0x42 it takes any byte but 0x52 for noise, the true 0x42 included, and waits for the next message.
#            errors stays 0. A message that is cut takes the next one with it, too.
# Hurts:     Anyone who reads an echo sounder over a line with noise: readings are missing and the link counts as
#            clean.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            bluerobotics-ping==0.2.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
from brping import PingMessage, PingParser, definitions

message = PingMessage(definitions.PING1D_DISTANCE)
message.distance = 1500
message.pack_msg_data()
packet = bytes(message.msg_data)
for name, stream in (
    ("whole", packet + packet),
    ("stray 0x41", b"\x41" + packet + packet),
    ("stray 0x42", b"\x42" + packet + packet),
    ("cut", packet[:10] + packet + packet),
):
    parser = PingParser()
    for byte in stream:
        parser.parse_byte(byte)
    print(name, parser.parsed, parser.errors)
END

cat >expected <<'END'
whole 2 0
stray 0x41 2 0
stray 0x42 1 0
cut 1 1
END
diff expected seen || { echo "CHANGED: ping-stray-start-byte" >&2; exit 1; }
echo "PASS: a stray 0x42 costs a whole message and no error is counted"
