#!/bin/sh
# SPDX-License-Identifier: MIT
# In canopen a signed object with a default of 0xFF9C is 65436 and cannot be read from its own node, while its lower
# limit of 0x8000 is -32768.
#
# Version:   canopen 2.4.1, python-can 4.6.1.
# Expected:  A hexadecimal number of an EDS file means the same in each line of an object: two's complement for signed
#            types, for which tools write them.
# Behaviour: Limits are read by type, defaults as plain numbers. A simulated node refuses to send what does not fit.
#            Limits of floating-point objects and a default of 010 are dropped without a word, and are missing in the
#            file that export_od writes.
# Hurts:     Anyone who simulates a device from its EDS, or compares what a device has with its default: an offset of
#            -100 differs from itself.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            canopen==2.4.1 \
            python-can==4.6.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >defaults.py <<'END'
import canopen

OBJECTS = {
    0x2000: ("Offset", 0x0003, "0xFF9C", "0x8000", "0x7FFF"),
    0x2001: ("Temperature", 0x0002, "-5", "-40", "85"),
    0x2002: ("Gain", 0x0008, "1.5", "0.5", "2.5"),
    0x2003: ("Range", 0x0006, "010", "0", "0x1388"),
}
lines = ["[DeviceInfo]", "VendorName=None", "[ManufacturerObjects]", f"SupportedObjects={len(OBJECTS)}"]
lines += [f"{count}={index:#x}" for count, index in enumerate(OBJECTS, 1)]
for index, (name, kind, default, low, high) in OBJECTS.items():
    lines += [f"[{index:X}]", f"ParameterName={name}", "ObjectType=0x7", f"DataType={kind:#06x}", "AccessType=rw"]
    lines += [f"DefaultValue={default}", f"LowLimit={low}", f"HighLimit={high}", "PDOMapping=0"]
with open("sonar.eds", "w") as file:
    file.write("\n".join(lines))

objects = canopen.import_od("sonar.eds", node_id=5)
node = canopen.LocalNode(5, objects)
for index, (name, _, default, low, high) in OBJECTS.items():
    seen = objects[index]
    try:
        read = seen.decode_raw(node.get_data(index, 0))
    except Exception as error:
        read = type(error).__name__
    print(f"{name} {default} in {low} to {high}: {seen.default} in {seen.min} to {seen.max}, read as {read}")
END
venv/bin/python defaults.py >seen 2>stderr

cat >expected <<'END'
Offset 0xFF9C in 0x8000 to 0x7FFF: 65436 in -32768 to 32767, read as ValueError
Temperature -5 in -40 to 85: -5 in -40 to 85, read as -5
Gain 1.5 in 0.5 to 2.5: 1.5 in None to None, read as 1.5
Range 010 in 0 to 0x1388: None in 0 to 5000, read as SdoAbortedError
END
diff expected seen || { echo "CHANGED: canopen-minus-100-is-65436" >&2; exit 1; }
echo "PASS: 0xFF9C is 65436, 0x8000 is -32768"
