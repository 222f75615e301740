#!/bin/sh
# SPDX-License-Identifier: MIT
# A derived register has no fields and another size in cmsis-svd, unless it has a description of its own.
#
# Version:   cmsis-svd 0.6.
# Expected:  A register that is derived from another one has all that it does not give itself: its fields, its size, its
#            description.
# Behaviour: Where the derived register gives no description, nothing is inherited. It stays there with its address,
#            with no fields and with the size of the device.
# Hurts:     Anyone who makes headers or a register view of an SVD file: SVD files leave out what is the same, and so
#            should be inherited.
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

for register in SVDParser.for_xml_file("ring.svd").get_device().peripherals[0].get_registers():
    fields = [field.name for field in register.get_fields()]
    print(register.name, hex(register.address_offset), register.size, "bits", fields, register.description)
END

cat >expected <<'END'
CTRL0 0x0 16 bits ['MODE'] Control
CTRL1 0x4 32 bits [] None
CTRL2 0x8 16 bits ['MODE'] Control
END
diff expected seen || { echo "CHANGED: cmsis-svd-derived-register" >&2; exit 1; }
echo "PASS: without a description of its own a derived register inherits nothing"
