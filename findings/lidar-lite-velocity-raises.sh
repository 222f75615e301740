#!/bin/sh
# SPDX-License-Identifier: MIT
# The velocity that lidar-lite promises cannot be had: get_velocity raises NameError on every call.
#
# Version:   lidar-lite 0.1.0, smbus2 0.6.1.
# Expected:  get_velocity returns the signed difference of the last two distances, as its description says.
# Behaviour: The register is read, then the method calls a function that does not exist under that name. The class has
#            a method of that name, which works.
# Hurts:     Anyone who looks at approaching obstacles with a LIDAR-Lite: distances are fine, so the first call comes
#            late.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            lidar-lite==0.1.0 \
            smbus2==0.6.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >velocity.py <<'END'
from LiDAR_Lite import LiDAR_Lite


class Bus:
    """A laser 3.00 m from a wall that comes 2 cm nearer between two measurements."""

    registers = {0x01: 0, 0x09: 0xFE, 0x0F: 0x01, 0x10: 0x2C}

    def read_byte_data(self, address, register):
        return self.registers[register]

    def write_byte_data(self, address, register, value):
        pass


laser = LiDAR_Lite()
laser.bus = Bus()
print("distance:", laser.get_distance())
try:
    print("velocity:", laser.get_velocity())
except NameError as error:
    print("velocity: NameError,", error)
print("signed() of the register:", laser.signed(laser.read_reg("VELOCITY")))
END
venv/bin/python velocity.py >seen

cat >expected <<'END'
distance: 300
velocity: NameError, name 'signed' is not defined
signed() of the register: -2
END
diff expected seen || { echo "CHANGED: lidar-lite-velocity-raises" >&2; exit 1; }
echo "PASS: the distance is read, the velocity raises NameError"
