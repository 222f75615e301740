#!/bin/sh
# SPDX-License-Identifier: MIT
# ld2410 keeps the low byte of the detection distance: somebody at 300 cm is detected at 44 cm, and a hold time of 300
# s is read as 44 s.
#
# Version:   ld2410 1.1.1, pyserial 3.5.
# Expected:  All distances of a report have 16 bits, and so has the time for which a detection is held.
# Behaviour: The distances of the moving and of the static target are read from two bytes, that of the detection from
#            one. It is right up to 255 cm, of 6 m that the sensor reaches. The hold time can be set up to 65535 and is
#            read modulo 256.
# Hurts:     Anyone who slows a robot down by the detection distance: the farther target seems nearer than the near
#            one.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            ld2410==1.1.1 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >presence.py <<'END'
import io
import logging
from unittest import mock

from LD2410.ld2410 import LD2410


def report(distance):
    """A report about somebody who stands still."""
    near = distance.to_bytes(2, "little")
    return bytes.fromhex("f4f3f2f1 0d00 02aa 02 0000 00") + near + b"\x50" + near + bytes.fromhex("5500 f8f7f6f5")


class Port:
    """A sensor that sends a report, and that holds a detection for 300 s."""

    def read(self, count=1):
        return self.stream.read(count)

    def write(self, order):
        parameters = bytes([8, 8, 8]) + bytes([50] * 9) + bytes([40] * 9) + (300).to_bytes(2, "little")
        answer = bytes.fromhex("fdfcfbfa 1c00 6101 0000 aa") + parameters + bytes.fromhex("04030201")
        self.stream = io.BytesIO(answer)


logging.disable(logging.CRITICAL)
port = Port()
with mock.patch("serial.Serial", lambda *arguments, **options: port):
    sensor = LD2410("a port")
for distance in (100, 250, 256, 300, 500):
    port.stream = io.BytesIO(report(distance))
    seen = sensor.get_radar_data()[0]
    print(f"somebody at {distance} cm: static target {seen[3]}, detection {seen[5]}")
print("a hold time of 300 s:", sensor.read_detection_params()[0][2])
END
venv/bin/python presence.py >seen

cat >expected <<'END'
somebody at 100 cm: static target 100, detection 100
somebody at 250 cm: static target 250, detection 250
somebody at 256 cm: static target 256, detection 0
somebody at 300 cm: static target 300, detection 44
somebody at 500 cm: static target 500, detection 244
a hold time of 300 s: 44
END
diff expected seen || { echo "CHANGED: ld2410-far-is-near" >&2; exit 1; }
echo "PASS: 300 cm are 300 as a target and 44 as a detection"
