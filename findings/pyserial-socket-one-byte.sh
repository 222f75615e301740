#!/bin/sh
# SPDX-License-Identifier: MIT
# in_waiting of a socket:// port of pyserial is 1 however many bytes wait, and 1 when the peer has gone.
#
# Version:   pyserial 3.5.
# Expected:  As with a serial port: eleven bytes that arrived are eleven, and none after the end.
# Behaviour: Only "something can be read" is asked. The usual read(in_waiting) gets one byte a call; after the end it
#            asks for one that never comes, and raises.
# Hurts:     Anyone who moves a program from a serial port to a gateway: one call a byte, and a poll that takes the
#            end for data.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
import socket
import time
import serial

with socket.create_server(("127.0.0.1", 0)) as server:
    port = serial.serial_for_url(f"socket://127.0.0.1:{server.getsockname()[1]}", timeout=1)
    peer, _ = server.accept()
    peer.sendall(b"hello world")
    time.sleep(0.2)
    print(port.in_waiting, port.read(port.in_waiting), port.read(10))
    peer.close()
    time.sleep(0.2)
    print(port.in_waiting)
    try:
        port.read(port.in_waiting)
    except serial.SerialException as error:
        print(error)
END

cat >expected <<'END'
1 b'h' b'ello world'
1
read failed: socket disconnected
END
diff expected seen || { echo "CHANGED: pyserial-socket-one-byte" >&2; exit 1; }
echo "PASS: eleven bytes wait and in_waiting is 1, as it is after the end"
