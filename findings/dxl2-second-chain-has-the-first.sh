#!/bin/sh
# SPDX-License-Identifier: MIT
# A second chain of dxl2 has the motors of the first one, and a chain whose motors were added later cannot be written.
#
# Version:   dxl2 0.1, dynamixel-sdk 4.1.0, pyserial 3.5.
# Expected:  Each chain has its own motors, and they can be moved together however they came there.
# Behaviour: The list of motors that a chain has by default is one for all chains. Whether the motors are of one kind
#            is asked when the chain is made, not when they are added: an empty chain is not, and so write_many_values
#            raises NotImplementedError. set_baud_rate ignores the rate that it is given, and sets the one of the
#            constructor.
# Hurts:     Anyone who drives two legs or two wheels by two chains, or changes the rate of the bus.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            dxl2==0.1 \
            dynamixel-sdk==4.1.0 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >chains.py <<'END'
from dxl2.connection import Connection
from dxl2.motor import Motor, MotorType
from dxl2.motor_chain import MotorChain
from dxl2.register import Instruction

connection = Connection("/dev/null")
connection.port_handler.setBaudRate = lambda rate: print("the port is set to", rate)
left = MotorChain(connection)
left.add_motors([Motor(connection, 1, MotorType.AX), Motor(connection, 2, MotorType.AX)])
right = MotorChain(connection)
right.add_motors([Motor(connection, 11, MotorType.AX)])
print("left:", [motor.id for motor in left.motors])
print("right:", [motor.id for motor in right.motors])
try:
    left.write_many_values(Instruction.GOAL_POSITION, {1: 512, 2: 512})
except NotImplementedError as error:
    print("written together:", error)
connection.set_baud_rate(57600)
END
venv/bin/python chains.py >seen

cat >expected <<'END'
left: [1, 2, 11]
right: [1, 2, 11]
written together: Bulk write not implemented
the port is set to 1000000
END
diff expected seen || { echo "CHANGED: dxl2-second-chain-has-the-first" >&2; exit 1; }
echo "PASS: a chain of motors 1 and 2 has motor 11, too"
