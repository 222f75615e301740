#!/bin/sh
# SPDX-License-Identifier: MIT
# A value of #1x in an SVD file, which stands for 2 and 3, is 2 alone in cmsis-svd.
#
# Version:   cmsis-svd 0.6.
# Expected:  Both values of the field have the name, or the x is still there to be seen.
# Behaviour: The x becomes 0. The value 3 has no name, and nothing tells that it should have one.
# Hurts:     Anyone who shows registers by name: a sonar that runs in mode 3 is shown without a mode.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            cmsis-svd==0.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >ring.svd <<'END'
<device schemaVersion="1.3"><name>RING</name><version>1</version><description>Ring</description>
<addressUnitBits>8</addressUnitBits><width>32</width><size>32</size><access>read-write</access>
<peripherals><peripheral><name>SONAR</name><baseAddress>0x40000000</baseAddress><registers>
<register><name>CTRL0</name><description>Control</description><addressOffset>0</addressOffset><size>16</size><fields>
<field><name>MODE</name><bitRange>[3:2]</bitRange><enumeratedValues>
<enumeratedValue><name>OFF</name><value>#00</value></enumeratedValue>
<enumeratedValue><name>TEST</name><value>#01</value></enumeratedValue>
<enumeratedValue><name>RUN</name><value>#1x</value></enumeratedValue>
</enumeratedValues></field></fields></register>
<register derivedFrom="CTRL0"><name>CTRL1</name><addressOffset>4</addressOffset></register>
<register derivedFrom="CTRL0"><name>CTRL2</name><description>Control</description><addressOffset>8</addressOffset></register>
</registers></peripheral></peripherals></device>
END
venv/bin/python - >seen <<'END'
from cmsis_svd.parser import SVDParser

field = SVDParser.for_xml_file("ring.svd").get_device().peripherals[0].get_registers()[0].get_fields()[0]
print(field.name, field.bit_width, "bits", {one.value: one.name for one in field.enumerated_values[0].enumerated_values})
END

cat >expected <<'END'
MODE 2 bits {0: 'OFF', 1: 'TEST', 2: 'RUN'}
END
diff expected seen || { echo "CHANGED: cmsis-svd-either-bit" >&2; exit 1; }
echo "PASS: #1x is 2 alone"
