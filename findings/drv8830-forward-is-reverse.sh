#!/bin/sh
# SPDX-License-Identifier: MIT
# forward() of drv8830 sets the outputs that its set_outputs documents as reverse, and the data sheet of the chip, too.
#
# Version:   drv8830 1.0.0, i2cdevice 1.0.0.
# Expected:  set_outputs(1, 0) is documented as forward and (0, 1) as reverse, so forward() and set_direction("forward")
#            do the same as the first.
# Behaviour: The names of the directions are laid on the two bits the other way round: forward() writes what
#            set_outputs(0, 1) writes. In the data sheet forward is the first input, bit 0, alone. Brake and coast
#            agree.
# Hurts:     Anyone who mixes the two ways, or wires by the data sheet: a robot that backs off from an obstacle drives
#            into it. Use set_outputs alone.
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

cat >direction.py <<'END'
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


bus = Bus()
motor = drv8830.DRV8830(i2c_dev=bus)
motor.set_voltage(2.0)
for name, outputs in (("forward", (1, 0)), ("reverse", (0, 1)), ("brake", (1, 1)), ("coast", (0, 0))):
    getattr(motor, name)()
    method = bus.registers[0][0] & 3
    motor.set_outputs(*outputs)
    documented = bus.registers[0][0] & 3
    print(f"{name}: {method:02b} by its method, {documented:02b} by set_outputs{outputs}")
END
venv/bin/python direction.py >seen

cat >expected <<'END'
forward: 10 by its method, 01 by set_outputs(1, 0)
reverse: 01 by its method, 10 by set_outputs(0, 1)
brake: 11 by its method, 11 by set_outputs(1, 1)
coast: 00 by its method, 00 by set_outputs(0, 0)
END
diff expected seen || { echo "CHANGED: drv8830-forward-is-reverse" >&2; exit 1; }
echo "PASS: forward() is what set_outputs documents as reverse"
