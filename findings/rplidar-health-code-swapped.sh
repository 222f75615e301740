#!/bin/sh
# SPDX-License-Identifier: MIT
# Two of three Python drivers of the RPLIDAR swap the bytes of its error code: 0x8001 is reported as 384.
#
# Version:   rplidar-roboticia 0.9.5, pyrplidar 0.1.2, rplidarc1 0.1.3, pyserial 3.5.
# Expected:  The error code of the health reply is read low byte first, as the protocol has it for each field of two
#            bytes and as these drivers read angles, distances and sample times, and rplidarc1 the code, too.
# Behaviour: It is read high byte first: 1 becomes 256, 0x8001 becomes 384. The status beside it, one byte, is right.
# Hurts:     Anyone who looks up the code of a laser that reports a warning, or collects such codes over a fleet.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            rplidar-roboticia==0.9.5 \
            pyrplidar==0.1.2 \
            rplidarc1==0.1.3 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >health.py <<'END'
import contextlib
import io
import os
import pty
import struct
import threading
import tty

import pyrplidar
import rplidar
from rplidarc1.protocol import Response

end, other = pty.openpty()
tty.setraw(end)
tty.setraw(other)
CODES = [0x0001, 0x8001]
left = [code for code in CODES for _ in range(2)]


def serve():
    """Answer requests for health and for sample times, low byte first."""
    while True:
        order = os.read(end, 2)[1]
        if order == 0x52:
            os.write(end, b"\xa5\x5a" + struct.pack("<IBBH", 3, 6, 1, left.pop(0)))
        if order == 0x59:
            os.write(end, b"\xa5\x5a" + struct.pack("<IBHH", 4, 0x15, 476, 238))


threading.Thread(target=serve, daemon=True).start()
name = os.ttyname(other)
one = rplidar.RPLidar(name)
two = pyrplidar.PyRPlidar()
with contextlib.redirect_stdout(io.StringIO()):
    two.connect(name)
for code in CODES:
    print(f"code {code}: rplidar reports {one.get_health()}, pyrplidar {two.get_health()},", end=" ")
    print("rplidarc1", Response.parse_error_code(struct.pack("<BH", 1, code)))
print("sample times of 476 and 238 us:", two.get_samplerate())
print(end="", flush=True)
os._exit(0)
END
venv/bin/python health.py >seen

cat >expected <<'END'
code 1: rplidar reports ('Warning', 256), pyrplidar {'status': 1, 'error_code': 256}, rplidarc1 1
code 32769: rplidar reports ('Warning', 384), pyrplidar {'status': 1, 'error_code': 384}, rplidarc1 32769
sample times of 476 and 238 us: {'t_standard': 476, 't_express': 238}
END
diff expected seen || { echo "CHANGED: rplidar-health-code-swapped" >&2; exit 1; }
echo "PASS: code 0x8001 is reported as 384 by two of three"
