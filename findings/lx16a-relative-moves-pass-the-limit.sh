#!/bin/sh
# SPDX-License-Identifier: MIT
# A relative move of pylx16a is held against the limits before it is added: it passes them, and one backwards is
# refused.
#
# Version:   pylx16a 1.1.1, pyserial 3.5.
# Expected:  move(-10, relative=True) goes back by 10 degrees, and one that would end beyond the limits is refused, as
#            an absolute one is.
# Behaviour: The step itself must lie within the limits, the sum is not looked at. With limits of 30 and 210 degrees a
#            step of 100 from 200 is sent as 300 degrees, and steps of 5 and of -40 are refused.
# Hurts:     Anyone who steers or tilts a sensor with these servos by steps: the horn runs into what the limits were
#            set for.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pylx16a==1.1.1 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >servo.py <<'END'
from pylx16a.lx16a import LX16A, ServoArgumentError

LIMITS = (125, 875)  # 30 and 210 degrees, in steps of 0.24
ANSWERS = {28: (833,), 21: LIMITS, 23: (4500, 12000), 30: (0, 0)}


class Port:
    """A bus with one servo at 200 degrees."""

    def write(self, packet):
        self.order, self.sent = packet[4], packet

    def read(self, count):
        words = b"".join(word.to_bytes(2, "little") for word in ANSWERS.get(self.order, ()))
        data = words or bytes([1 if self.order == 32 else 0] * (count - 6))
        packet = [0x55, 0x55, 1, count - 3, self.order, *data[: count - 6]]
        return bytes([*packet, LX16A._checksum(packet)])


LX16A._controller = Port()
for degrees, relative in ((220, False), (5, True), (-40, True), (100, True)):
    servo = LX16A(1)
    name = f"{degrees} {'more' if relative else 'degrees'} from 200, limits 30 to 210"
    try:
        servo.move(degrees, relative=relative)
        sent = int.from_bytes(servo._controller.sent[5:7], "little")
        print(f"{name}: sent as {sent * 0.24:.0f} degrees")
    except ServoArgumentError as error:
        print(f"{name}: refused, {str(error).partition('angle ')[2]}")
END
venv/bin/python servo.py >seen

cat >expected <<'END'
220 degrees from 200, limits 30 to 210: refused, must be between 30.0 and 210.0 (received 220)
5 more from 200, limits 30 to 210: refused, must be between 30.0 and 210.0 (received 5)
-40 more from 200, limits 30 to 210: refused, must be between 0 and 240 (received -40)
100 more from 200, limits 30 to 210: sent as 300 degrees
END
diff expected seen || { echo "CHANGED: lx16a-relative-moves-pass-the-limit" >&2; exit 1; }
echo "PASS: 100 degrees more than 200 are sent as 300"
