#!/bin/sh
# SPDX-License-Identifier: MIT
# Most orders of gs2d to a Dynamixel send nothing and return None, without an error: among them limits, the number of
# the servo and write().
#
# Version:   gs2d 0.0.4, pyserial 3.5.
# Expected:  A method that is not made yet raises, as set_speed() and some others of the class do, or it is not there.
# Behaviour: The body of the method is commented out behind the test of the servo's number. Only ping, torque,
#            temperature and position send packets. Values that are asked for, such as the voltage, are None.
# Hurts:     Anyone who sets limits before a sensor is turned: the servo turns through them into its cable.
#            dynamixel-sdk writes the same registers.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            gs2d==0.0.4 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >limits.py <<'END'
import time

from gs2d import RobotisP20


class Bus:
    """A bus that counts what is sent and never answers."""

    sent = 0

    def is_open(self):
        return True

    def write(self, data):
        self.sent += 1

    def read(self):
        time.sleep(0.01)
        return b""

    def close(self):
        pass


bus = Bus()
servo = RobotisP20(bus)
servo.command_handler.RECEIVE_DATA_TIMEOUT_SEC = 0.1
for name, arguments in (
    ("set_torque_enable", (True, 1)),
    ("set_target_position", (30, 1)),
    ("set_limit_cw_position", (-90, 1)),
    ("set_limit_ccw_position", (90, 1)),
    ("set_max_torque", (50, 1)),
    ("set_target_time", (2, 1)),
    ("set_servo_id", (2, 1)),
    ("save_rom", (1,)),
    ("write", (1, 65, b"\x01")),
    ("get_voltage", (1,)),
    ("get_current", (1,)),
):
    bus.sent = 0
    value = getattr(servo, name)(*arguments)
    time.sleep(0.3)
    print(f"{name}{arguments}: packets {bus.sent}, returns {value}")
servo.close()
END
venv/bin/python limits.py >seen

cat >expected <<'END'
set_torque_enable(True, 1): packets 1, returns True
set_target_position(30, 1): packets 1, returns True
set_limit_cw_position(-90, 1): packets 0, returns None
set_limit_ccw_position(90, 1): packets 0, returns None
set_max_torque(50, 1): packets 0, returns None
set_target_time(2, 1): packets 0, returns None
set_servo_id(2, 1): packets 0, returns None
save_rom(1,): packets 0, returns None
write(1, 65, b'\x01'): packets 0, returns None
get_voltage(1,): packets 0, returns None
get_current(1,): packets 0, returns None
END
diff expected seen || { echo "CHANGED: gs2d-limits-are-not-sent" >&2; exit 1; }
echo "PASS: limits are accepted and not sent"
