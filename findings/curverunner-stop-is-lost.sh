#!/bin/sh
# SPDX-License-Identifier: MIT
# curverunner loses an order on a busy I2C bus without an error, and cannot drive backwards there: after a lost stop
# the motor runs on.
#
# Version:   curverunner 0.2.0, smbus2 0.6.1, pyserial 3.5.
# Expected:  An order that could not be written raises, as a reading that failed does. -0.5 is half speed backwards on
#            each kind of connection.
# Behaviour: A write is tried five times, then it is given up in silence. An order is two writes, speed and mode: where
#            the first one is lost the old speed stays in force. Negative speeds raise OverflowError by I2C; by the
#            serial port they are sent.
# Hurts:     Anyone who drives by I2C beside sensors on the same bus.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            curverunner==0.2.0 \
            smbus2==0.6.1 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >stop.py <<'END'
from curverunner import Curverunner
from curverunner.comm import CurverunnerCommI2C, CurverunnerCommSerial


class Bus:
    """A bus with a controller, that can be busy for a while."""

    def __init__(self):
        self.registers, self.busy = bytearray(256), 0

    def write_i2c_block_data(self, _, register, data):
        if self.busy:
            self.busy -= 1
            raise OSError("busy")
        self.registers[register : register + len(data)] = bytes(data)

    def read_i2c_block_data(self, _, register, count):
        return list(self.registers[register : register + count])


class Port:
    """A serial port whose controller takes all."""

    def write(self, data):
        self.last = data

    def readline(self):
        return b"0" if self.last.startswith(b"R") else b"S"


bus = Bus()
motor = Curverunner(CurverunnerCommI2C(bus)).motor1
target = lambda: int.from_bytes(bus.registers[30:32], "little", signed=True) / 32767
motor.set_percent_out(0.5)
print(f"half speed: {target():.2f}")
bus.busy = 5
print(f"stop, while the bus is busy for 0.1 s: returns {motor.set_percent_out(0)}, speed in the controller {target():.2f}")
try:
    motor.set_percent_out(-0.5)
except OverflowError as error:
    print("backwards by I2C:", error)
port = Port()
motor = Curverunner(CurverunnerCommSerial(port)).motor1
sent = []
port.write = lambda data: (sent.append(data), setattr(port, "last", data))
motor.set_percent_out(-0.5)
print("backwards by the serial port:", sent[0])
END
venv/bin/python stop.py >seen

cat >expected <<'END'
half speed: 0.50
stop, while the bus is busy for 0.1 s: returns None, speed in the controller 0.50
backwards by I2C: can't convert negative int to unsigned
backwards by the serial port: b'W2,30,-16383\n'
END
diff expected seen || { echo "CHANGED: curverunner-stop-is-lost" >&2; exit 1; }
echo "PASS: a stop on a busy bus is lost without an error"
