#!/bin/sh
# SPDX-License-Identifier: MIT
# With the camera on, the proximity ring of an e-puck becomes older with each step of unifr_api_epuck.
#
# Version:   unifr_api_epuck 1.3.11.
# Expected:  go_on gives an order and reads all that the robot sends in return, so that get_prox is of this step.
# Behaviour: An e-puck2 whose camera and sensors are asked for sends two packets for each order, as the drivers of
#            others expect. go_on reads one. The other waits: after 20 steps the ring is 10 steps old, after 100 it is
#            50, and an image is of every second step.
# Hurts:     Anyone who avoids obstacles and looks at once: the robot turns away from where it was.
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

cat >camera.py <<'END'
import contextlib
import io
import socket
import sys
from unittest.mock import MagicMock

for name in ("torch", "torch.nn", "torch.nn.functional", "torch.cuda", "torchvision", "cv2", "requests", "socketio", "pandas", "matplotlib", "matplotlib.pyplot", "PIL", "seaborn", "scipy", "yaml", "tqdm"):
    sys.modules[name] = MagicMock()


class Socket:
    """A connection to an e-puck whose first proximity sensor counts the orders."""

    def __init__(self, *args):
        self.there, self.orders = b"", 0

    def setsockopt(self, *args):
        pass

    settimeout = connect = setsockopt

    def send(self, data):
        self.orders += 1
        if data[1] & 1:
            self.there += b"\x01" + bytes(160 * 120 * 2)
        if data[1] & 2:
            self.there += b"\x02" + bytes(37) + self.orders.to_bytes(2, "little") + bytes(65)
        return len(data)

    def recv(self, size):
        data, self.there = self.there[:size], self.there[size:]
        return data


with contextlib.redirect_stdout(io.StringIO()):
    from unifr_api_epuck.epuck.epuck_wifi import WifiEpuck

    made = []
    socket.socket = lambda *args: made.append(Socket()) or made[-1]
for camera in (False, True):
    with contextlib.redirect_stdout(io.StringIO()):
        robot = WifiEpuck("robot")
        robot.init_sensors()
        if camera:
            robot.init_camera()
    begin = made[-1].orders
    ages = []
    for step in range(1, 101):
        robot.go_on()
        if step in (2, 20, 100):
            ages.append((step, begin + step - robot.get_prox()[0]))
    print("camera" if camera else "no camera", "- steps and the age of the ring in steps:", ages)
END
venv/bin/python camera.py >seen

cat >expected <<'END'
no camera - steps and the age of the ring in steps: [(2, 0), (20, 0), (100, 0)]
camera - steps and the age of the ring in steps: [(2, 1), (20, 10), (100, 50)]
END
diff expected seen || { echo "CHANGED: unifr-epuck-camera-ages-the-ring" >&2; exit 1; }
echo "PASS: after 100 steps with the camera the ring is 50 steps old"
