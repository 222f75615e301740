#!/bin/sh
# SPDX-License-Identifier: MIT
# A sonar called 07 is called 7 after xacro, and one with the serial number 90125e1 is called 901250.0.
#
# Version:   xacro 2.1.1.
# Expected:  What stands as text in a property or a parameter and is put into a name comes out as it was written.
# Behaviour: Text that reads like a number becomes one and is written anew: zeros in front go, 2.10 becomes 2.1 and 12e5
#            1200000.0. What begins with 0x, and 9e125e1, stay as they are.
# Hurts:     Anyone who names frames, joints or devices by number, by version, or by a serial number or hash that
#            happens to read like a number: the driver waits for a frame that does not exist.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            xacro==2.1.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >ring.xacro <<'END'
<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="ring">
<xacro:macro name="sonar" params="id"><link name="sonar_${id}"/></xacro:macro>
<xacro:sonar id="07"/>
<xacro:sonar id="2.10"/>
<xacro:sonar id="004512"/>
<xacro:sonar id="90125e1"/>
<xacro:sonar id="9e125e1"/>
<xacro:sonar id="0x10"/>
<xacro:property name="front" value="00"/>
<link name="sonar_${front}"/>
</robot>
END
venv/bin/xacro ring.xacro | sed -n 's/.*<link name="\(.*\)".*/\1/p' >seen

cat >expected <<'END'
sonar_7
sonar_2.1
sonar_4512
sonar_901250.0
sonar_9e125e1
sonar_0x10
sonar_0
END
diff expected seen || { echo "CHANGED: xacro-sonar-07" >&2; exit 1; }
echo "PASS: sonar 07 becomes 7"
