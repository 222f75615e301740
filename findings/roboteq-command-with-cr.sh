#!/bin/sh
# SPDX-License-Identifier: MIT
# A command that ends with a carriage return is never sent by roboteq 0.8, and what the controller answers is spelt as
# b'V'b'='b'2'.
#
# Version:   roboteq 0.8, pyserial 3.5.
# Expected:  send_command adds the carriage return that is missing and sends the command; getdata gives the text that
#            came.
# Behaviour: The command is written only where the return was missing: one that has it, as in the manual of the
#            controller, is dropped without an error. getdata joins the Python spellings of single bytes. Parameters
#            that were left out are sent as the word None.
# Hurts:     Anyone who sends a stop that was written with its return, or reads voltages and counters.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            roboteq==0.8 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >command.py <<'END'
from roboteq.roboteq_device import RoboteqDevice


class Port:
    """A controller that has answered already."""

    def __init__(self, answer):
        self.answer, self.written = answer, []

    def inWaiting(self):
        return len(self.answer)

    def read(self, count=1):
        first, self.answer = self.answer[:count], self.answer[count:]
        return first

    def write(self, data):
        self.written.append(data)


for call, command in (("send_command", ("!G 1 100",)), ("send_command", ("!G 1 0\r",)), ("command_motor", ("!MS",)), ("command_motor", ("!G", 1, 100))):
    device = RoboteqDevice()
    device.ser = Port(b"")
    getattr(device, call)(*command)
    print(f"{call}{command}: sent {device.ser.written}")
device.ser = Port(b"V=245\r")
print("answer V=245:", device.getdata())
END
venv/bin/python command.py >seen

cat >expected <<'END'
send_command('!G 1 100',): sent [b'!G 1 100\r']
send_command('!G 1 0\r',): sent []
command_motor('!MS',): sent [b'!MS None None\r']
command_motor('!G', 1, 100): sent [b'!G 1 100\r']
answer V=245: b'V'b'='b'2'b'4'b'5'b'\r'
END
diff expected seen || { echo "CHANGED: roboteq-command-with-cr" >&2; exit 1; }
echo "PASS: a command with its carriage return is not sent"
