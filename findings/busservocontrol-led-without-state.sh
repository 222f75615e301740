#!/bin/sh
# SPDX-License-Identifier: MIT
# set_led_state and set_error_led of BusServoControl send the order without what was chosen: 0 and 1 make the same
# packet.
#
# Version:   BusServoControl 0.2.
# Expected:  The packet has the state or the faults as its parameter, as the orders of the protocol have.
# Behaviour: Both orders are sent with no parameter, for all states and faults. A servo that was to blink at a blocked
#            rotor keeps its setting. A whole number as a text is taken as hexadecimal: an angle given as the text 500
#            is sent as 1280, beyond the end of 1000.
# Hurts:     Anyone who relies on the alarm of a servo, or passes angles on from a form or a file.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            BusServoControl==0.2 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >servo.py <<'END'
from BusServoControl import BusServoControl


class Port:
    def sendmsg(self, text):
        sent.append(" ".join(text[i : i + 2] for i in range(0, len(text), 2)).upper())


sent = []
servo = BusServoControl(Port())
for name, order in (
    ("LED on", lambda: servo.set_led_state(1, 0)),
    ("LED off", lambda: servo.set_led_state(1, 1)),
    ("no alarm", lambda: servo.set_error_led(1, 0)),
    ("alarm if blocked", lambda: servo.set_error_led(1, 4)),
    ("load off", lambda: servo.set_load_state(1, 0)),
    ("to 500", lambda: servo.move_time_write(1, 500, 1000)),
    ('to "500"', lambda: servo.move_time_write(1, "500", 1000)),
):
    order()
    print(f"{name}: {sent[-1]}")
print("the angle was", int.from_bytes(bytes.fromhex(sent[-1])[5:7], "little"))
END
venv/bin/python servo.py >seen

cat >expected <<'END'
LED on: 55 55 01 03 21 DA
LED off: 55 55 01 03 21 DA
no alarm: 55 55 01 03 23 D8
alarm if blocked: 55 55 01 03 23 D8
load off: 55 55 01 04 1F 00 DB
to 500: 55 55 01 07 01 F4 01 E8 03 16
to "500": 55 55 01 07 01 00 05 E8 03 06
the angle was 1280
END
diff expected seen || { echo "CHANGED: busservocontrol-led-without-state" >&2; exit 1; }
echo "PASS: LED on and LED off are one packet"
