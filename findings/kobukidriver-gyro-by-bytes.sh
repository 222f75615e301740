#!/bin/sh
# SPDX-License-Identifier: MIT
# kobukidriver makes two turn rates of each sample of the gyroscope, one of its low byte and one of its high byte,
# both positive.
#
# Version:   kobukidriver 0.0.1.
# Expected:  A sample is 16 bits with a sign, 0.00875 degrees a second per count, and gyro_velocity_data has one value
#            for each.
# Behaviour: Each byte is scaled by itself: -100 counts, -0.875 degrees a second, is 1.365 and 2.231. The conversion to
#            integers beside it joins the bytes, but without the sign: 65436.
# Hurts:     Anyone who integrates a heading: it turns to one side only, at a rate that has no relation to the true
#            one.
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

cat >gyro.py <<'END'
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


for counts in (100, -100, 1000):
    seen = robot(feedback((2000,) * 3, (10, 10), [0, 0, counts] * 2))
    values = seen.gyro_velocity_data()["angular velocity of z: "]
    whole = seen.gyro_intconverted_data()["z_axis_converted_to_int: "]
    print(f"2 samples of {counts} counts, {counts * 0.00875:.3f} deg/s: {[round(value, 3) for value in values]} deg/s, integers {whole}")
END
venv/bin/python gyro.py >seen

cat >expected <<'END'
2 samples of 100 counts, 0.875 deg/s: [0.875, 0.0, 0.875, 0.0] deg/s, integers [100, 100]
2 samples of -100 counts, -0.875 deg/s: [1.365, 2.231, 1.365, 2.231] deg/s, integers [65436, 65436]
2 samples of 1000 counts, 8.750 deg/s: [2.03, 0.026, 2.03, 0.026] deg/s, integers [1000, 1000]
END
diff expected seen || { echo "CHANGED: kobukidriver-gyro-by-bytes" >&2; exit 1; }
echo "PASS: two samples of -0.875 deg/s are four of 1.365 and 2.231"
