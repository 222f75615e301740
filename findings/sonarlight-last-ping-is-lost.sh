#!/bin/sh
# SPDX-License-Identifier: MIT
# sonarlight leaves out the last ping of every SL2 and SL3 file, and reads a file of one ping as an error.
#
# Version:   sonarlight 0.1.7, pandas 2.2.3, numpy 1.26.4.
# Expected:  A file of four pings is read as four.
# Behaviour: A ping is kept only if another one comes behind it, so of four there are three. A file with one ping raises
#            KeyError.
# Hurts:     Anyone who joins the pieces that a chart plotter writes: one ping is missing at each joint, and each
#            recording ends before its last position. A copy of the file that has its last ping twice is read whole.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            sonarlight==0.1.7 \
            pandas==2.2.3 \
            numpy==1.26.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >pings.py <<'END'
import struct

from sonarlight import Sonar

ECHO = bytes(range(100))


def ping(number, start, previous):
    """Return a ping of an SL2 file: 144 bytes of head, then 100 of echo; ranges and depth in feet."""
    head = bytearray(144)
    struct.pack_into("<I", head, 0, start)
    struct.pack_into("<HHHHI", head, 28, 244, previous, 0, len(ECHO), number)
    struct.pack_into("<ff", head, 40, 0.0, 32.808399)
    struct.pack_into("<I", head, 60, 1700000000)
    struct.pack_into("<f", head, 64, 16.4041995)
    struct.pack_into("<I", head, 140, 100 * number)
    return bytes(head) + ECHO


def recording(pings):
    head = struct.pack("<HHHH", 2, 1, 3200, 0)
    return head + b"".join(ping(i, 8 + 244 * i, 244 if i else 0) for i in range(pings))


for what, data in (
    ("4 pings", recording(4)),
    ("2 pings", recording(2)),
    ("1 ping", recording(1)),
    ("4 pings, the last one twice", recording(4) + recording(4)[-244:]),
):
    open("lake.sl2", "wb").write(data)
    try:
        print(f"{what}:", Sonar("lake.sl2").df["id"].tolist())
    except Exception as error:
        print(f"{what}: {type(error).__name__}")
END
venv/bin/python pings.py >seen

cat >expected <<'END'
4 pings: [0, 1, 2]
2 pings: [0]
1 ping: KeyError
4 pings, the last one twice: [0, 1, 2, 3]
END
diff expected seen || { echo "CHANGED: sonarlight-last-ping-is-lost" >&2; exit 1; }
echo "PASS: of four pings three are read"
