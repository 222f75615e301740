#!/bin/sh
# SPDX-License-Identifier: MIT
# set_baud_rate of ld2410 changes the rate of the sensor and then raises KeyError, with the port closed.
#
# Version:   ld2410 1.1.1, pyserial 3.5.
# Expected:  With reconnect=True, which is the default, the sensor is restarted and the port opened again at the new
#            rate.
# Behaviour: The rate is looked up twice, the second time by a number where the table has codes. That happens after the
#            sensor was told the new rate and to restart, and after the port was closed. factory_reset ends in the same
#            way.
# Hurts:     Anyone who lowers the rate for a long cable: the program ends, and when it is started again it talks to
#            the sensor at the old rate.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            ld2410==1.1.1 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >rate.py <<'END'
import logging
from unittest import mock

from LD2410.ld2410 import LD2410, PARAM_BAUD_115200

ORDERS = {"a100": "new rate", "a200": "factory reset", "a300": "restart"}


class Port:
    """A sensor that takes all orders."""

    def __init__(self, name, rate, timeout):
        print("    port opened at", rate)

    def write(self, order):
        code = order[6:8].hex()
        if code in ORDERS:
            print("    sensor received:", ORDERS[code])

    def read(self, count):
        return b""

    def close(self):
        print("    port closed")


logging.disable(logging.CRITICAL)
with mock.patch("serial.Serial", Port):
    for name, arguments in (("set_baud_rate", (PARAM_BAUD_115200,)), ("factory_reset", ())):
        print(name)
        sensor = LD2410("a port")
        try:
            getattr(sensor, name)(*arguments)
        except KeyError as error:
            print("    KeyError", error)
END
venv/bin/python rate.py >seen

cat >expected <<'END'
set_baud_rate
    port opened at 256000
    sensor received: new rate
    sensor received: restart
    port closed
    KeyError 115200
factory_reset
    port opened at 256000
    sensor received: factory reset
    sensor received: restart
    port closed
    KeyError 256000
END
diff expected seen || { echo "CHANGED: ld2410-baud-rate-half-changed" >&2; exit 1; }
echo "PASS: the sensor takes the new rate, then KeyError is raised"
