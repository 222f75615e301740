#!/bin/sh
# SPDX-License-Identifier: MIT
# adafruit_tfmini that begins to read between the two header bytes of a packet stays out of step until it times out.
#
# Version:   adafruit-circuitpython-tfmini 1.2.25.
# Expected:  A reader that starts in the middle of a packet is in step with the next one, 10 ms later.
# Behaviour: A first byte 0x59 takes eight more with it, whatever the second is. Packets have nine bytes, so from the
#            second header byte on each try ends where it began. The same happens with a range of 89 cm, whose low byte
#            is 0x59, one byte later. After a second it raises.
# Hurts:     Anyone who reads the laser in a loop: each reading begins with an empty buffer at any moment, so about one
#            in a hundred takes a second and fails.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            adafruit-circuitpython-tfmini==1.2.25 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >laser.py <<'END'
import itertools

import adafruit_tfmini


class Port:
    """A serial port on which packets of one range come without end, from a byte of the first one on."""

    baudrate = 115200

    def __init__(self, distance_cm, first):
        body = bytes([0x59, 0x59]) + distance_cm.to_bytes(2, "little") + bytes([100, 0, 2, 0])
        packet = body + bytes([sum(body) & 0xFF])
        self.stream = itertools.islice(itertools.cycle(packet), first, None)

    def reset_input_buffer(self):
        pass

    def read(self, count):
        return bytes(itertools.islice(self.stream, count))


for distance_cm in (120, 89):
    for first in range(9):
        laser = adafruit_tfmini.TFmini(Port(distance_cm, first), timeout=0.2)
        try:
            seen = f"{laser.distance} cm"
        except RuntimeError as error:
            seen = str(error)
        print(f"{distance_cm} cm, from byte {first} on: {seen}")
END
venv/bin/python laser.py >seen

cat >expected <<'END'
120 cm, from byte 0 on: 120 cm
120 cm, from byte 1 on: Timed out looking for valid data
120 cm, from byte 2 on: 120 cm
120 cm, from byte 3 on: 120 cm
120 cm, from byte 4 on: 120 cm
120 cm, from byte 5 on: 120 cm
120 cm, from byte 6 on: 120 cm
120 cm, from byte 7 on: 120 cm
120 cm, from byte 8 on: 120 cm
89 cm, from byte 0 on: 89 cm
89 cm, from byte 1 on: Timed out looking for valid data
89 cm, from byte 2 on: Timed out looking for valid data
89 cm, from byte 3 on: 89 cm
89 cm, from byte 4 on: 89 cm
89 cm, from byte 5 on: 89 cm
89 cm, from byte 6 on: 89 cm
89 cm, from byte 7 on: 89 cm
89 cm, from byte 8 on: 89 cm
END
diff expected seen || { echo "CHANGED: tfmini-never-in-step" >&2; exit 1; }
echo "PASS: from the second header byte on it is never in step"
