#!/bin/sh
# SPDX-License-Identifier: MIT
# A RedBoard that is made with another range of its pulse width drives at another speed: with 2000 instead of 1000
# full speed is half.
#
# Version:   redboard 0.1.8, approxeng.hwsupport 0.1.12, PyYAML 6.0.4.
# Expected:  The range is the number of steps between off and full: m0 = 1.0 is full speed with each of them.
# Behaviour: The pins of the motors are set up with the range that was asked for, and driven with steps of the default
#            one. With 2000 full speed is 1000 of 2000; with 500 each speed above a half asks for more steps than there
#            are. The LED uses the right range.
# Hurts:     Anyone who raises the range for finer speeds: the robot is slow, and its odometry by commands is off by
#            the factor.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            redboard==0.1.8 \
            approxeng.hwsupport==0.1.12 \
            PyYAML==6.0.4 \
            future-fstrings==1.2.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >speed.py <<'END'
import sys
from unittest.mock import MagicMock

for module in ("pigpio", "smbus2", "PIL", "luma", "luma.core", "luma.core.interface", "luma.core.interface.serial", "luma.core.render", "luma.oled", "luma.oled.device"):
    sys.modules[module] = MagicMock()  # of the Raspberry Pi

import pigpio
import redboard

MOTOR = 18
for asked in (1000, 2000, 500):
    pins = pigpio.pi.return_value = MagicMock()
    board = redboard.RedBoard(motor_expansion_addresses=[], pwm_range=asked)
    (steps,) = {call.args[1] for call in pins.set_PWM_range.call_args_list if call.args[0] == MOTOR}
    pins.set_PWM_dutycycle.reset_mock()
    board.m0 = 1.0
    (duty,) = [call.args[1] for call in pins.set_PWM_dutycycle.call_args_list if call.args[0] == MOTOR]
    print(f"range {asked}: the pin has {steps} steps, full speed is {duty:.0f} of them")
END
venv/bin/python speed.py >seen

cat >expected <<'END'
range 1000: the pin has 1000 steps, full speed is 1000 of them
range 2000: the pin has 2000 steps, full speed is 1000 of them
range 500: the pin has 500 steps, full speed is 1000 of them
END
diff expected seen || { echo "CHANGED: redboard-range-halves-the-speed" >&2; exit 1; }
echo "PASS: with a range of 2000 full speed is half"
