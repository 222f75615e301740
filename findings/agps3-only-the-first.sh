#!/bin/sh
# SPDX-License-Identifier: MIT
# Of messages from gpsd that arrive together agps3 gives the first and drops the others.
#
# Version:   agps3 0.36.1.
# Expected:  The lines of a stream come one after the other, whatever piece they arrive in.
# Behaviour: For each message a new file is made of the socket. It reads all that has arrived, gives one line, and is
#            forgotten with the rest.
# Hurts:     Anyone who reads every 0.2 s, as the threaded client does, while gpsd sends position, satellites and
#            attitude within one: what comes behind the first is not there. Read the socket by makefile() once, outside.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            agps3==0.36.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >together.py <<'END'
import json
import socket
import time

from agps3 import agps3

MESSAGES = [{"class": "TPV", "mode": 3, "lat": 52.5}, {"class": "SKY", "hdop": 0.9}, {"class": "ATT", "heading": 90.0}]
LINES = [json.dumps(message) + "\n" for message in MESSAGES]


def read(pieces, pause):
    """Return the classes of what is read when gpsd sends these pieces with a pause between them."""
    daemon, client = socket.socketpair()
    gpsd = agps3.GPSDSocket()
    gpsd.streamSock = client
    client.setblocking(False)
    seen = []
    for piece in pieces:
        daemon.sendall(piece.encode())
        time.sleep(0.05)
        if pause:
            seen.append(gpsd.next(timeout=0))
    for _ in range(4):
        seen.append(gpsd.next(timeout=0))
    daemon.close()
    client.close()
    return [json.loads(line)["class"] for line in seen if line]


print("sent one by one, read after each:", read(LINES, True))
print("sent together, read four times:", read(["".join(LINES)], False))
END
venv/bin/python together.py >seen

cat >expected <<'END'
sent one by one, read after each: ['TPV', 'SKY', 'ATT']
sent together, read four times: ['TPV']
END
diff expected seen || { echo "CHANGED: agps3-only-the-first" >&2; exit 1; }
echo "PASS: of three messages the first is given"
