#!/bin/sh
# SPDX-License-Identifier: MIT
# In kobukidriver all three cliff sensors read 5 and both motors draw 6, whatever is below the robot.
#
# Version:   kobukidriver 0.0.1.
# Expected:  The three cliff sensors of a Kobuki are three numbers of 16 bits, the currents two bytes.
# Behaviour: Each of the five is the first byte of its part of the packet, which is the identifier of that part: 5 for
#            the cliffs and 6 for the currents.
# Hurts:     Anyone who stops at an edge or at a blocked wheel by them: there never is one.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            kobukidriver==0.0.1 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >cliffs.py <<'END'
import contextlib

from kobukidriver.Kobuki import Kobuki


def feedback(cliffs, currents, rates):
    """Return a feedback packet of a Kobuki: all parts that it sends at 50 Hz."""
    parts = [
        (1, bytes(15)),
        (3, bytes(3)),
        (4, bytes(7)),
        (5, b"".join(value.to_bytes(2, "little") for value in cliffs)),
        (6, bytes(currents)),
        (13, bytes([0, len(rates)]) + b"".join(rate.to_bytes(2, "little", signed=True) for rate in rates)),
        (16, bytes(16)),
    ]
    body = b"".join(bytes([name, len(data)]) + data for name, data in parts)
    packet = bytes([len(body)]) + body
    check = 0
    for byte in packet:
        check ^= byte
    return b"\xaa\x55" + packet + bytes([check])


class Port:
    """A serial port that has received packets."""

    def __init__(self, data):
        self.data = data

    def read(self, size):
        if size > len(self.data):
            raise EOFError
        data, self.data = self.data[:size], self.data[size:]
        return data


def robot(packet):
    """Return the driver after it has read packets, all alike."""
    assert packet[2] == 77, "the length that the driver looks for"
    Kobuki.seri = Port(packet[2:] + packet * 4)
    with contextlib.suppress(EOFError):
        Kobuki.read_data()
    return object.__new__(Kobuki)


for name, cliffs, currents in (("on the floor", (2000, 2000, 2000), (10, 10)), ("left over an edge, right wheel blocked", (2000, 1900, 120), (10, 90))):
    seen = robot(feedback(cliffs, currents, [0] * 6))
    print(f"{name}: cliffs right, centre, left {cliffs}, currents left, right {currents}")
    print("   ", seen.cliffsensor_data())
    print("   ", seen.current_data())
END
venv/bin/python cliffs.py >seen

cat >expected <<'END'
on the floor: cliffs right, centre, left (2000, 2000, 2000), currents left, right (10, 10)
    {'right_cliff_sensor': 5, 'central_cliff_sensor': 5, 'left_cliff_sensor': 5}
    {'Leftmotor': 6, 'Rightmotor': 6}
left over an edge, right wheel blocked: cliffs right, centre, left (2000, 1900, 120), currents left, right (10, 90)
    {'right_cliff_sensor': 5, 'central_cliff_sensor': 5, 'left_cliff_sensor': 5}
    {'Leftmotor': 6, 'Rightmotor': 6}
END
diff expected seen || { echo "CHANGED: kobukidriver-cliffs-are-five" >&2; exit 1; }
echo "PASS: cliffs of 2000, 1900 and 120 are read as 5, 5 and 5"
