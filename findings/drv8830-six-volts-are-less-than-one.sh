#!/bin/sh
# SPDX-License-Identifier: MIT
# A motor that drv8830 sets to 6 V gets 0.8, and one set to 5.2 V stands still: what does not fit into six bits is cut
# off.
#
# Version:   drv8830 1.0.0, i2cdevice 1.0.0.
# Expected:  A voltage above the documented limit of 5.06 V is refused or is the limit.
# Behaviour: The number of the step runs over the field of six bits, and the rest is written: from 5.13 V on the motor
#            begins at standstill again, 6 V are 0.8 V. Below 0.48 V it stands, as documented. Between, the value is
#            always rounded down: 2 V are 1.93 V, and 4 V are 3.94 V although 4.02 is nearer to 4.
# Hurts:     Anyone who gives a motor all of a battery of 6 V, or whose controller has no limit: the harder it pushes
#            the slower it drives. Limit the value to 5.06.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            drv8830==1.0.0 \
            i2cdevice==1.0.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >voltage.py <<'END'
import drv8830


class Bus:
    """An I2C bus with one chip that keeps its registers."""

    def __init__(self) -> None:
        self.registers = {}

    def write_i2c_block_data(self, address: int, register: int, values: list[int]) -> None:
        """Write VALUES to REGISTER."""
        self.registers[register] = values

    def read_i2c_block_data(self, address: int, register: int, length: int) -> list[int]:
        """Return what was written to REGISTER last."""
        return self.registers.get(register, [0] * length)


motor = drv8830.DRV8830(i2c_dev=Bus())
for volts in (0.4, 0.5, 2.0, 4.0, 5.06, 5.1, 5.2, 6.0, 9.0):
    motor.set_voltage(volts)
    print(f"{volts} V: {motor.get_voltage()} V")
END
venv/bin/python voltage.py >seen

cat >expected <<'END'
0.4 V: 0 V
0.5 V: 0.48 V
2.0 V: 1.93 V
4.0 V: 3.94 V
5.06 V: 5.06 V
5.1 V: 5.06 V
5.2 V: 0 V
6.0 V: 0.8 V
9.0 V: 3.86 V
END
diff expected seen || { echo "CHANGED: drv8830-six-volts-are-less-than-one" >&2; exit 1; }
echo "PASS: 6 V are 0.8 V, and 5.2 V are nothing"
