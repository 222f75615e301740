#!/bin/sh
# SPDX-License-Identifier: MIT
# Each goal that dynamixel_control sends to an XL-320 sets its speed to 0, which is no limit, and angles need a servo
# with the number 0.
#
# Version:   dynamixel_control 0.2.4, dynamixel-sdk 4.1.0, pyserial 3.5, numpy 2.4.6.
# Expected:  A goal changes the goal position alone, two bytes at 30; the speed at 32 stays what it was set to.
# Behaviour: The goal of an XL-320 is written as four bytes, as that of an XL-330 is. The upper two, zeros, are the
#            speed, and 0 stands for the full one. set_speed raises KeyError for an XL-320. The conversion of angles
#            asks for the type of servo 0: KeyError where the servos are 1 and 2.
# Hurts:     Anyone who turns a sensor by an XL-320, slowly, or numbers servos from 1 on.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            dynamixel_control==0.2.4 \
            dynamixel-sdk==4.1.0 \
            pyserial==3.5 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >goal.py <<'END'
import contextlib
import io

import dynamixel_sdk
from dynamixel_sdk import GroupBulkWrite

dynamixel_sdk.PortHandler.openPort = dynamixel_sdk.PortHandler.setBaudRate = lambda *arguments: True

from dynamixel_control.dynamixel import Dynamixel

sent = {}


def send(group):
    for servo, (data, address, length) in group.data_list.items():
        sent[servo] = (address, length, list(data))
    return 0


GroupBulkWrite.txPacket = send
with contextlib.redirect_stdout(io.StringIO()):
    arm = Dynamixel("/dev/null")
arm.add_dynamixel(type="XL-320", ID_number=1)
arm.update_goal(1, 600)
arm.send_goal()
address, length, data = sent[1]
memory = {30: 0, 31: 0, 32: 50, 33: 0}  # goal and speed of an XL-320, the speed set to 50
memory.update(zip(range(address, address + length), data))
print("goal", memory[30] | memory[31] << 8, "speed", memory[32] | memory[33] << 8)
for name, call in (("speed", lambda: arm.set_speed(50)), ("angle", lambda: arm.convert_rad_to_pos(0.5))):
    try:
        call()
    except KeyError as error:
        print(f"{name}: KeyError: {error}")
END
venv/bin/python goal.py >seen

cat >expected <<'END'
goal 600 speed 0
speed: KeyError: 'ADDR_velocity_cap'
angle: KeyError: 0
END
diff expected seen || { echo "CHANGED: dynamixel-control-goal-at-full-speed" >&2; exit 1; }
echo "PASS: a goal of 600 sets the speed from 50 to 0"
