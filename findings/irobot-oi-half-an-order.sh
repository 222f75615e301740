#!/bin/sh
# SPDX-License-Identifier: MIT
# iRobot_OI sends the first byte of an order and then raises: the robot takes the next order, a stop perhaps, for the
# missing bytes.
#
# Version:   iRobot_OI 0.1.0, pyserial 3.5.
# Expected:  lowSideDrivers(True, False, False) sends 138 and 1, queryList(7, 8) sends 149 2 7 8, baud(57600) sends 129
#            and 10. An order that cannot be made sends nothing.
# Behaviour: lowSideDrivers raises UnboundLocalError unless all are off, queryList and baud raise TypeError whatever
#            they are given. By then the opcode is sent, in queryList the count as well, so the robot waits for one or
#            more bytes and takes those of the next order: driveDirect(0, 0) right behind is no stop any more. The same
#            holds for a velocity beyond 16 bits.
# Hurts:     Anyone who catches the error and drives on. Send the bytes with utils.sendBytes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            iRobot_OI==0.1.0 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >orders.py <<'END'
import iRobot_OI as create


class Wire:
    """A serial port that keeps what is written."""

    def __init__(self) -> None:
        self.sent = bytearray()

    def write(self, data: bytes) -> None:
        """Keep DATA, as pyserial does: no text."""
        if isinstance(data, str):
            raise TypeError("unicode strings are not supported")
        self.sent += data


def take(stream: list[int]) -> list[list[int]]:
    """Return the orders that a Create makes of STREAM."""
    lengths = {129: 1, 138: 1, 145: 4}
    orders = []
    while stream:
        length = stream[1] + 1 if stream[0] == 149 and len(stream) > 1 else lengths.get(stream[0], 0)
        orders.append(stream[: 1 + length])
        stream = stream[1 + length :]
    return orders


def show(name: str, order, *values) -> None:
    """Print what is sent by ORDER and a stop behind it."""
    create.oi, create.DEBUG = Wire(), False
    try:
        order(*values)
        result = "sent"
    except (UnboundLocalError, TypeError) as error:
        result = type(error).__name__
    create.actuator.driveDirect(0, 0)
    print(f"{name}: {result}, the robot takes it and a stop for", take(list(create.oi.sent)))


show("driveDirect(100, 100)", create.actuator.driveDirect, 100, 100)
show("lowSideDrivers(False, False, False)", create.actuator.lowSideDrivers, False, False, False)
show("lowSideDrivers(True, False, False)", create.actuator.lowSideDrivers, True, False, False)
show("queryList(7, 8)", create.input.queryList, 7, 8)
show("baud(57600)", create.baud, 57600)
END
venv/bin/python orders.py >seen

cat >expected <<'END'
driveDirect(100, 100): sent, the robot takes it and a stop for [[145, 0, 100, 0, 100], [145, 0, 0, 0, 0]]
lowSideDrivers(False, False, False): sent, the robot takes it and a stop for [[138, 0], [145, 0, 0, 0, 0]]
lowSideDrivers(True, False, False): UnboundLocalError, the robot takes it and a stop for [[138, 145], [0], [0], [0], [0]]
queryList(7, 8): TypeError, the robot takes it and a stop for [[149, 2, 145, 0], [0], [0], [0]]
baud(57600): TypeError, the robot takes it and a stop for [[129, 145], [0], [0], [0], [0]]
END
diff expected seen || { echo "CHANGED: irobot-oi-half-an-order" >&2; exit 1; }
echo "PASS: a stop behind an order that raised is taken for its bytes"
