#!/bin/sh
# SPDX-License-Identifier: MIT
# One damaged line of the infrared sensors ends the receiver of mirto_asip_manager for good, and all sensors keep
# their last values.
#
# Version:   mirto_asip_manager 1.0.5, pyserial 3.5.
# Expected:  A line that cannot be read is logged and passed over, as there is a number of attempts for that.
# Behaviour: The second attempt, before it looks at the line, leaves the program: sys.exit(). In the thread that reads
#            the port this ends the thread alone, without a message beyond the log. Encoders and infrared sensors stay
#            what they were, and motors still obey.
# Hurts:     Anyone who drives a Mirto by its sensors: after one lost byte it drives on by the last line it has seen.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            mirto_asip_manager==1.0.5 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >robot.py <<'END'
import logging
import sys
import threading
import types

import serial

settings = sys.modules["mirto_asip_manager.settings"] = types.ModuleType("settings")  # it logs to /var/log
settings.logging = logging
logging.disable(logging.CRITICAL)

from mirto_asip_manager import asip_manager, serialConnector
from mirto_asip_manager.services import Encoders, IRSensors

LINES = [
    "@R,e,3,{100,200,300}",
    "@M,e,2,{3000:110,3100:120}",
    "@R,e,3,{100,2,}",  # a byte was lost
    "@R,e,3,{500,500,500}",
    "@M,e,2,{3000:210,3100:220}",
]


class Port:
    """A serial port on which the lines come, one by one."""

    def isOpen(self):
        return True

    def read(self):
        if not lines:
            running.clear()
            return b""
        byte, lines[:] = lines[0], lines[1:]
        return bytes([byte])


def received(damaged):
    """Return the encoders and infrared sensors after all lines."""
    lines[:] = "".join(line + "\n" for line in LINES if damaged or not line.endswith(",}")).encode()
    running.set()
    manager = asip_manager.AsipManager.__new__(asip_manager.AsipManager)
    manager.all_services = {"encoders": Encoders("Encoders", None), "ir_sensors": IRSensors("IR", 1, None)}
    serial.Serial = Port
    connection = serialConnector.SerialConnection()
    reader = threading.Thread(target=connection.receive_data, args=(running, manager.run_services, running.clear))
    reader.start()
    reader.join()
    return manager.all_services["ir_sensors"].ir_all_values, manager.all_services["encoders"].all_values, len(lines)


lines, running = bytearray(), threading.Event()
for name, damaged in (("all lines whole", False), ("one line cut", True)):
    infrared, encoders, left = received(damaged)
    print(f"{name}: infrared {infrared}, encoders {encoders}, {left} bytes not read")
END
venv/bin/python robot.py >seen

cat >expected <<'END'
all lines whole: infrared [500, 500, 500], encoders [[3000, 210], [3100, 220]], 0 bytes not read
one line cut: infrared [100, 200, 300], encoders [[3000, 110], [3100, 120]], 48 bytes not read
END
diff expected seen || { echo "CHANGED: mirto-one-cut-line-freezes-all" >&2; exit 1; }
echo "PASS: after one cut line nothing is read any more"
