#!/bin/sh
# SPDX-License-Identifier: MIT
# An answer that arrives in two pieces is the value "DEBUG MODE: Received faulty message, ignoring..." in PyRoboteq,
# whether it debugs or not.
#
# Version:   PyRoboteq 0.1.2, pyserial 3.5.
# Expected:  read_value waits for the end of the line, or raises an error, and gives V=245.
# Behaviour: It takes what is there at the first look and splits it at the carriage returns. Where the answer is not
#            complete, a sentence is returned as if the controller had said it, and the rest of the answer is read as
#            the next one. The query itself is sent with the brackets of the manual and a plus: ?V [1]+.
# Hurts:     Anyone who parses numbers out of the values, or shows them.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            PyRoboteq==0.1.2 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >pieces.py <<'END'
from PyRoboteq import RoboteqHandler


class Port:
    """A controller that echoes a query and answers it, in pieces."""

    def __init__(self, *pieces):
        self.pieces, self.written = list(pieces), []

    def read_all(self):
        return self.pieces.pop(0)

    def write(self, data):
        self.written.append(data)


handler = RoboteqHandler()
handler.ser = Port(b"?V [1]+\rV=245\r", b"?V [1]+", b"\rV=246\r", b"?A [1]+\rA=12\r")
for query in ("?V", "?V", "?A"):
    print(f"read_value({query!r}, 1): {handler.read_value(query, 1)!r}")
print("sent first:", handler.ser.written[0])
END
venv/bin/python pieces.py >seen

cat >expected <<'END'
read_value('?V', 1): 'V=245'
read_value('?V', 1): 'DEBUG MODE: Received faulty message, ignoring...'
read_value('?A', 1): 'V=246'
sent first: b'?V [1]+\r'
END
diff expected seen || { echo "CHANGED: pyroboteq-answer-in-two-pieces" >&2; exit 1; }
echo "PASS: an answer in two pieces is a sentence, and its rest the next answer"
