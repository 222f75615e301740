#!/bin/sh
# SPDX-License-Identifier: MIT
# A Thymio that drives backwards has a speed of 65436 in thymiodirect, where -100 was written.
#
# Version:   thymiodirect 0.1.2.
# Expected:  The variables of a Thymio are 16 bits with a sign; what was written as -100 is read as -100.
# Behaviour: The values received are numbers without a sign. What is written stays -100 in the copy that is read, until
#            the next refresh, a tenth of a second later.
# Hurts:     Anyone who reads speeds, accelerations or temperatures: right at first sight and wrong 0.1 s later.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            thymiodirect==0.1.2 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >speed.py <<'END'
import struct

from thymiodirect.connection import RemoteNode
from thymiodirect.message import Message


def received(*values):
    """Return what a message with values of a robot is decoded to."""
    message = Message(Message.ID_VARIABLES, 1, struct.pack("<H", 0) + struct.pack(f"<{len(values)}h", *values))
    message.decode()
    return message.var_offset, message.var_data


node = RemoteNode(1)
node.add_var("motor.left.speed", 1)
node.add_var("acc", 3)
node.reset_var_data()
node.set_var_data(*received(0, 0, 0, 22))
node.set_var("motor.left.speed", -100)
print("written -100, read", node.get_var("motor.left.speed"))
sent = Message.uint16array_to_bytes([-100])
print("sent", struct.unpack("<h", sent)[0])
node.set_var_data(*received(-100, -3, 1, 22))
print("after a refresh with -100 and (-3, 1, 22):", node.get_var("motor.left.speed"), node.get_var_array("acc"))
END
venv/bin/python speed.py >seen

cat >expected <<'END'
written -100, read -100
sent -100
after a refresh with -100 and (-3, 1, 22): 65436 [65533, 1, 22]
END
diff expected seen || { echo "CHANGED: thymiodirect-never-backwards" >&2; exit 1; }
echo "PASS: a speed of -100 is read as 65436"
