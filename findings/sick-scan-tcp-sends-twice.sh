#!/bin/sh
# SPDX-License-Identifier: MIT
# sick-scan-tcp sends each command twice, the second time as Python spells bytes, and so every other scan is an error
# message.
#
# Version:   sick-scan-tcp 1.0.1.
# Expected:  One call of scan() sends one telegram and returns its answer; set_start_stop_angle(-45, 225) sends -45
#            degrees.
# Behaviour: What is to be done after a lost connection is done always: the telegram goes out again, wrapped once more.
#            The laser answers that with an error, which the next call takes for its own answer. -45 degrees are sent
#            as X6DDD0, which is no number of the protocol.
# Hurts:     Anyone who reads an LMS or TiM by it: the second scan cannot be decoded, and the sector in front cannot be
#            chosen.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            sick-scan-tcp==1.0.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >laser.py <<'END'
import contextlib
import io
import socket
import threading
import time

from sick_scan_tcp import SickScan

received = []
server = socket.create_server(("127.0.0.1", 0))


def telegrams(connection):
    data = b""
    while chunk := connection.recv(4096):
        data += chunk
        while b"\x03" in data:
            telegram, data = data.split(b"\x03", 1)
            yield telegram.lstrip(b"\x02")


def answer(connection):
    with contextlib.suppress(OSError):
        for telegram in telegrams(connection):
            received.append(telegram.decode())
            time.sleep(0.2)
            good = telegram.split()[0] in (b"sRN", b"sWN", b"sMN")
            connection.sendall(b"\x02sRA LMDscandata\x03" if good else b"\x02sFA 3\x03")


def laser():
    while True:
        threading.Thread(target=answer, args=(server.accept()[0],), daemon=True).start()


threading.Thread(target=laser, daemon=True).start()
scanner = SickScan("127.0.0.1", server.getsockname()[1])
for number in (1, 2):
    print(f"scan {number} returns", scanner.scan())
time.sleep(1)
print("the laser has received:")
for telegram in received:
    print("   ", telegram)

received.clear()
with contextlib.redirect_stdout(io.StringIO()):
    SickScan("127.0.0.1", server.getsockname()[1]).set_start_stop_angle(-45, 225)
time.sleep(1)
print("angles -45 and 225:", next(t for t in received if t.startswith("sWN")))
END
venv/bin/python laser.py >seen

cat >expected <<'END'
scan 1 returns sRA LMDscandata
scan 2 returns sFA 3
the laser has received:
    sRN LMDscandata
    b'\x02sRN LMDscandata\x03'
    sRN LMDscandata
    b'\x02sRN LMDscandata\x03'
angles -45 and 225: sWN LMPoutputRange 1 1388 X6DDD0 225510
END
diff expected seen || { echo "CHANGED: sick-scan-tcp-sends-twice" >&2; exit 1; }
echo "PASS: each command is sent twice, the second time as the spelling of bytes"
