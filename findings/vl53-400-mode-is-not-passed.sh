#!/bin/sh
# SPDX-License-Identifier: MIT
# The option --mode of vl53_400_lib changes nothing: the word mode is passed on, not what was chosen.
#
# Version:   vl53_400_lib 0.1.2, click 8.3.1.
# Expected:  --mode modbus sends the order that ends the stream of text, --mode iic the one for I2C.
# Behaviour: No order is sent and no error shown. A wrong word is refused, as if the right ones were of use.
# Hurts:     Anyone who prepares several sensors for one bus: they go on sending text.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            vl53_400_lib==0.1.2 \
            click==8.3.1 \
            loguru==0.7.3 \
            modbus-crc==1.3 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >mode.py <<'END'
import serial
from click.testing import CliRunner
from loguru import logger

sent = []


class Port:
    """A serial port that notes what is written to it."""

    def __init__(self, **kwargs):
        pass

    def write(self, data):
        sent.append(bytes(data).hex(" "))


serial.Serial = Port
logger.remove()
logger.remove = lambda handler: None
from vl53_400_lib.device_access import SerialAccess
from vl53_400_lib.main import cli

for mode in ("serial", "modbus", "iic", "uart"):
    sent.clear()
    result = CliRunner().invoke(cli, ["--mode", mode])
    print(f"--mode {mode}: exit code {result.exit_code}, sent {sent}")
sent.clear()
SerialAccess("port", 115200).set_sensor_mode("modbus")
print("set_sensor_mode of the library, modbus:", sent)
END
venv/bin/python mode.py >seen

cat >expected <<'END'
--mode serial: exit code 0, sent []
--mode modbus: exit code 0, sent []
--mode iic: exit code 0, sent []
--mode uart: exit code 2, sent []
set_sensor_mode of the library, modbus: ['50 06 00 38 00 01 c4 46']
END
diff expected seen || { echo "CHANGED: vl53-400-mode-is-not-passed" >&2; exit 1; }
echo "PASS: --mode modbus sends nothing"
