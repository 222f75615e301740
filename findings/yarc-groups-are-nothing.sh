#!/bin/sh
# SPDX-License-Identifier: MIT
# In yarc a group of sensors that contains an unused byte is no value at all: streamed alone it is an empty list,
# beside others it shifts them.
#
# Version:   yarc 0.9.3.
# Expected:  stream(callback, 'GROUP_7_26', 'OI_MODE') gives the group and the mode.
# Behaviour: The group has a filler in it, packet 16 of iRobot's Open Interface, and is passed over as a filler itself:
#            alone it gives []. Beside others its value is taken for theirs: the voltage is a group, and the mode
#            raises. Groups without a filler are right.
# Hurts:     Anyone who streams all sensors of a Create 2 at once, as is usual: 15 ms later there is nothing.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            yarc==0.9.3 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >groups.py <<'END'
import serial
from yarc import Roomba


class Port:
    """A serial port with a Create 2: safe mode, 14800 mV, all else 0."""

    baudrate, timeout, is_open = 115200, 1, False
    in_waiting = 0

    def __init__(self, *args, **kwargs):
        self.there = b""

    def write(self, data):
        if data[0] == 148:
            groups = {0: bytes(17) + (14800).to_bytes(2, "big") + bytes(7), 2: bytes(6), 35: b"\x02", 22: (14800).to_bytes(2, "big")}
            groups[3] = groups[0][16:]
            body = b"".join(bytes([name]) + groups[name] for name in data[2:])
            packet = bytes([19, len(body)]) + body
            self.answer = packet + bytes([-sum(packet) & 255])

    def reset_input_buffer(self):
        self.there = self.answer

    def read(self, size):
        data, self.there = self.there[:size], self.there[size:]
        return data


robot = Roomba.__new__(Roomba)
robot.serial = Port()
for names in (["GROUP_17_20"], ["OI_MODE", "VOLTAGE"], ["GROUP_7_26"], ["GROUP_7_26", "OI_MODE"], ["GROUP_7_26", "VOLTAGE"]):
    seen = []
    try:
        robot.stream(lambda values: seen.append(values), *names)
        print(*names, "->", [getattr(value, "name", value if isinstance(value, int) else type(value).__name__) for value in seen[0]])
    except Exception as error:
        print(*names, "->", type(error).__name__)
END
venv/bin/python groups.py >seen

cat >expected <<'END'
GROUP_17_20 -> ['Group1720']
OI_MODE VOLTAGE -> ['SAFE', 14800]
GROUP_7_26 -> []
GROUP_7_26 OI_MODE -> ValueError
GROUP_7_26 VOLTAGE -> ['Group726']
END
diff expected seen || { echo "CHANGED: yarc-groups-are-nothing" >&2; exit 1; }
echo "PASS: streaming GROUP_7_26 gives an empty list"
