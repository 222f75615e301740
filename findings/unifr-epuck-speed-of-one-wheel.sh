#!/bin/sh
# SPDX-License-Identifier: MIT
# get_speed of unifr_api_epuck reports the low byte of the right wheel's speed as right and its high byte as left.
#
# Version:   unifr_api_epuck 1.3.11.
# Expected:  get_speed is what set_speed was given, left and right.
# Behaviour: It takes bytes 5 and 6 of the order, which are the right wheel's, one for each wheel. Left has no
#            influence; 3 straight on is 0.01 and 0.58, -3 is 2.39 and 1.83.
# Hurts:     Anyone who makes odometry of an e-puck from it, or changes one wheel and leaves the other.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            unifr_api_epuck==1.3.11 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >speed.py <<'END'
import contextlib
import io
import socket
import sys
import types
from unittest.mock import MagicMock

for name in ("torch", "torch.nn", "torch.nn.functional", "torch.cuda", "torchvision", "cv2", "requests", "socketio", "pandas", "matplotlib", "matplotlib.pyplot", "PIL", "seaborn", "scipy", "yaml", "tqdm"):
    sys.modules[name] = MagicMock()


class Socket:
    """A connection to an e-puck that is content with every order."""

    orders = []

    def __init__(self, *args):
        self.there = b""

    def setsockopt(self, *args):
        pass

    settimeout = connect = setsockopt

    def send(self, data):
        Socket.orders.append(bytes(data))
        self.there += b"\x02" + bytes(104)
        return len(data)

    def recv(self, size):
        data, self.there = self.there[:size], self.there[size:]
        return data


with contextlib.redirect_stdout(io.StringIO()):
    from unifr_api_epuck.epuck.epuck_wifi import WifiEpuck

    socket.socket = Socket
    robot = WifiEpuck("robot")
for left, right in ((3, 3), (1, 3), (-3, -3), (3, 0)):
    robot.set_speed(left, right)
    robot.go_on()
    order = Socket.orders[-1]
    steps = [int.from_bytes(order[at : at + 2], "little", signed=True) for at in (3, 5)]
    seen = [round(speed, 2) for speed in robot.get_speed()]
    print(f"set_speed({left}, {right}): sent {steps} steps/s, get_speed() {seen}")
END
venv/bin/python speed.py >seen

cat >expected <<'END'
set_speed(3, 3): sent [318, 318] steps/s, get_speed() [0.01, 0.58]
set_speed(1, 3): sent [106, 318] steps/s, get_speed() [0.01, 0.58]
set_speed(-3, -3): sent [-318, -318] steps/s, get_speed() [2.39, 1.83]
set_speed(3, 0): sent [318, 0] steps/s, get_speed() [0.0, 0.0]
END
diff expected seen || { echo "CHANGED: unifr-epuck-speed-of-one-wheel" >&2; exit 1; }
echo "PASS: a speed of 3 on both wheels is reported as 0.01 and 0.58"
