#!/bin/sh
# SPDX-License-Identifier: MIT
# pyserial cannot open a pseudo terminal that ser2net serves by RFC 2217, unless it is told not to wait.
#
# Version:   pyserial 3.5, ser2net 4.3.11 (Debian 12).
# Expected:  A pty has no modem lines, so requests for them are answered as done, as the request for a baud rate is.
# Behaviour: ser2net does not answer the request for a line. pyserial waits 3 s, then raises. With ?ign_set_control it
#            opens the same port and data pass.
# Hurts:     Anyone who tests a gateway with an emulated device before the real one: no link, and a message about an
#            option "control".
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pyserial==3.5 || return 1
    apt-get -qq -s install ser2net=4.3.11-1 >plan &&
        sed -n 's/^Inst \([^ ]*\).*/\1/p' plan | xargs -r apt-get -qq download &&
        find . -name '*.deb' -exec dpkg -x {} debian \; || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }
PATH="$PWD/debian/usr/bin:$PWD/debian/usr/sbin:$PATH"
LD_LIBRARY_PATH="$PWD/debian/usr/lib/$(uname -m)-linux-gnu"
export PATH LD_LIBRARY_PATH

cat >serve.py <<'END'
import os
import pty
import socket
import subprocess
import time
import tty
import serial

controller, device = pty.openpty()
tty.setraw(device)
with socket.create_server(("127.0.0.1", 0)) as probe:
    port = probe.getsockname()[1]
with open("gateway.yaml", "w") as file:
    file.write(
        f"connection: &gateway\n  accepter: telnet(rfc2217),tcp,127.0.0.1,{port}\n"
        f"  connector: serialdev,{os.ttyname(device)},9600n81,local\n"
    )
gateway = subprocess.Popen(["ser2net", "-n", "-c", "gateway.yaml"], stderr=subprocess.DEVNULL)
try:
    for option in ("", "?ign_set_control"):
        for _ in range(50):
            try:
                socket.create_connection(("127.0.0.1", port)).close()
                break
            except OSError:
                time.sleep(0.2)
        time.sleep(1)
        try:
            with serial.serial_for_url(f"rfc2217://127.0.0.1:{port}{option}", baudrate=9600, timeout=10) as link:
                os.write(controller, b"hello")
                print(option or "plain", link.read(5))
        except serial.SerialException as error:
            print(option or "plain", error)
finally:
    gateway.terminate()
    gateway.wait()
END
venv/bin/python serve.py >seen

cat >expected <<'END'
plain timeout while waiting for option 'control'
?ign_set_control b'hello'
END
diff expected seen || { echo "CHANGED: rfc2217-on-a-pty" >&2; exit 1; }
echo "PASS: plain the port times out, with ign_set_control it opens"
