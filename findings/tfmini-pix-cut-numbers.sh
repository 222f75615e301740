#!/bin/sh
# SPDX-License-Identifier: MIT
# tfmini in its text mode takes the rest of a cut line for a range: 12.34 m is read as 2.34, 0.34, 34 and 4 m, too.
#
# Version:   tfmini 0.3.2, pyserial 3.5.
# Expected:  The first line after the input was discarded may have lost its beginning, so it is discarded, too.
# Behaviour: Each reading empties the input and takes what comes up to the first end of line. In a line that has begun
#            the rest of the number is a number, mostly.
# Hurts:     Anyone who uses the mode that autopilots read: the sensor writes lines all the time, so a part of the
#            readings is a number with digits missing in front.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            tfmini==0.3.2 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >lines.py <<'END'
import contextlib
import io

from tfmini.tfmini import Pix


class Port:
    """A serial port on which lines come without end, from a character of the first one on."""

    is_open = False

    def __init__(self, first):
        self.stream = (b"12.34\r\n" * 10)[first:]

    def flushInput(self):
        pass

    def read(self, count):
        data, self.stream = self.stream[:count], self.stream[count:]
        return data


for first in range(7):
    laser = Pix.__new__(Pix)
    laser.serial = Port(first)
    with contextlib.redirect_stdout(io.StringIO()):
        distance, _ = laser.get(2)
    print(f"12.34 from character {first} on: {distance}")
END
venv/bin/python lines.py >seen

cat >expected <<'END'
12.34 from character 0 on: 12.34
12.34 from character 1 on: 2.34
12.34 from character 2 on: 0.34
12.34 from character 3 on: 34.0
12.34 from character 4 on: 4.0
12.34 from character 5 on: None
12.34 from character 6 on: 12.34
END
diff expected seen || { echo "CHANGED: tfmini-pix-cut-numbers" >&2; exit 1; }
echo "PASS: 12.34 m is read as 2.34, 0.34, 34 and 4"
