#!/bin/sh
# SPDX-License-Identifier: MIT
# disable_all of aiorobot enables the events of all devices of a Root robot, and set_callback raises AttributeError for
# every event.
#
# Version:   aiorobot 0.3.0, crc8 0.2.1.
# Expected:  disable_all sends the order of disable, with all devices, and set_callback does for one event what
#            set_callbacks does for several.
# Behaviour: disable_all sends byte for byte what enable_all sends, apart from the number of the packet. set_callback
#            looks for a class that the driver has not got.
# Hurts:     Anyone who wants silence on the radio link before a long drive: the robot goes on reporting, and starts
#            with what was off. disable(Devices.ALL) works, and so does set_callbacks.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            aiorobot==0.3.0 \
            crc8==0.2.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >disable.py <<'END'
import asyncio
import sys
import types

sys.modules["bleak"] = types.ModuleType("bleak")  # Bluetooth is not needed here
from aiorobot.driver import Devices, Driver
from aiorobot.robot import RobotEvents

NAMES = {7: "enable", 9: "disable"}


class Client:
    """A robot in reach: it prints the orders."""

    async def write_gatt_char(self, where, packet):
        print(f"  device {packet[0]}, command {packet[1]} ({NAMES[packet[1]]}), devices {packet[3:19].hex().lstrip('0')}")


async def called(event):
    pass


async def main():
    robot = types.SimpleNamespace(_driver=Driver(Client(), None, None))
    events = RobotEvents(robot)
    print("enable_all:")
    await events.enable_all()
    print("disable_all:")
    await events.disable_all()
    print("disable(Devices.ALL):")
    await events.disable(Devices.ALL)
    events.set_callbacks(bumper_event=called)
    print("set_callbacks: done")
    try:
        events.set_callback("bumper_event", called)
    except AttributeError as error:
        print("set_callback: AttributeError:", error)


asyncio.run(main())
END
venv/bin/python disable.py >seen

cat >expected <<'END'
enable_all:
  device 0, command 7 (enable), devices 12703f
disable_all:
  device 0, command 7 (enable), devices 12703f
disable(Devices.ALL):
  device 0, command 9 (disable), devices 12703f
set_callbacks: done
set_callback: AttributeError: module 'aiorobot.driver' has no attribute '_Event'
END
diff expected seen || { echo "CHANGED: aiorobot-disable-is-enable" >&2; exit 1; }
echo "PASS: disable_all sends command 7, which enables"
