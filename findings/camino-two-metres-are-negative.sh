#!/bin/sh
# SPDX-License-Identifier: MIT
# A range of 200 that an Arduino sends by camino in one byte is -56, and an order whose answer was lost is carried out
# again, up to three times.
#
# Version:   camino 1.7.0, pyserial 3.5.
# Expected:  A number comes back as it was sent out, and a move is made once or reported as uncertain.
# Behaviour: Numbers of any length are taken as signed by default, while an argument must be from 0 to 255: 200 goes
#            out and comes back as -56. When an answer is damaged or missing the whole order is sent again. There is no
#            number in it by which the board could see that it has had it.
# Hurts:     Anyone who reads ranges in centimetres, or moves by steps.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            camino==1.7.0 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >calls.py <<'END'
import logging

import serial

logging.disable(logging.CRITICAL)


class Board:
    """An Arduino with two calls: 2 returns its argument, 3 moves by one step; lost answers are not received."""

    def __init__(self, **settings):
        self.answer, self.steps, self.lost = b"", 0, 0

    def write(self, packet):
        call, data = packet[3], packet[5:-1]
        if call == 3:
            self.steps += 1
        data = {0: b"\x04", 1: {b"\2": b"echo", b"\3": b"step"}.get(data, b""), 2: data, 3: b""}[call]
        body = bytes([len(data)]) + data
        self.answer = b"\xac\xac" + body + bytes([sum(body) % 256]) if data else b"\xa9\xa9"
        if call == 3 and self.lost:
            self.lost -= 1
            self.answer = b""

    def read(self, count):
        taken, self.answer = self.answer[:count], self.answer[count:]
        return taken

    def flush(self):
        pass

    flushInput = flushOutput = flush


serial.Serial = Board

from camino import Arduino, CaminoException, SerialConnection

connection = SerialConnection()
arduino = Arduino(connection)
for number in (100, 127, 128, 200):
    print(f"echo of {number}: {arduino.echo(number, out=int)}")
for lost in (0, 1, 2, 3):
    connection.port.steps, connection.port.lost = 0, lost
    try:
        arduino.step()
        told = "done"
    except CaminoException:
        told = "failed"
    print(f"one step, {lost} answers lost: {told}, {connection.port.steps} steps made")
END
venv/bin/python calls.py >seen

cat >expected <<'END'
echo of 100: 100
echo of 127: 127
echo of 128: -128
echo of 200: -56
one step, 0 answers lost: done, 1 steps made
one step, 1 answers lost: done, 2 steps made
one step, 2 answers lost: done, 3 steps made
one step, 3 answers lost: failed, 3 steps made
END
diff expected seen || { echo "CHANGED: camino-two-metres-are-negative" >&2; exit 1; }
echo "PASS: 200 comes back as -56, and one step is up to three"
