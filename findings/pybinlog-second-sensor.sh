#!/bin/sh
# SPDX-License-Identifier: MIT
# pybinlog loses the second of two sensors, or writes both into one file, depending on the first six messages.
#
# Version:   pybinlog 0.3.4, pymavlink 2.4.50.
# Expected:  Messages of an ArduPilot log with an instance number become one CSV file for each instance.
# Behaviour: Which instances there are is taken from the first six messages, and they are counted from 0 on. With a
#            second GPS that starts later, both are in one file; of instances 0 and 2 the file of the latter is empty
#            and its data nowhere.
# Hurts:     Anyone who compares two receivers, or whose log has a sensor that woke up late or took the place of
#            another.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            pybinlog==0.3.4 \
            pymavlink==2.4.50 \
            fastcrc==0.3.2 \
            lxml==6.1.3 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >second.py <<'END'
import contextlib
import io
import os
import struct

from utils.bin2csv import convert2csv


def log(name, instances):
    """Write a log of ArduPilot with BARO messages of these instances, one each 0.1 s."""
    form = struct.Struct("<BB4s16s64s")

    def describe(kind, size, title, kinds, columns):
        return b"\xa3\x95\x80" + form.pack(kind, size, title, kinds, columns)

    data = describe(128, 89, b"FMT", b"BBnNZ", b"Type,Length,Name,Format,Columns")
    data += describe(130, 3 + 8 + 1 + 4, b"BARO", b"QBf", b"TimeUS,I,Alt")
    for number, instance in enumerate(instances):
        data += b"\xa3\x95\x82" + struct.pack("<QBf", 1000000 + 100000 * number, instance, 100 * instance + number)
    with open(name, "wb") as file:
        file.write(data)


for name, instances in (("even", [0, 1] * 6), ("late", [0] * 6 + [0, 1] * 3), ("gap", [0, 2] * 6)):
    os.mkdir(name)
    log(f"{name}.bin", instances)
    with contextlib.redirect_stdout(io.StringIO()):
        convert2csv(f"{name}.bin", "BARO", name)
    print(f"{name}: {instances.count(0)} of instance 0, {len(instances) - instances.count(0)} of instance {max(instances)}")
    for file in sorted(os.listdir(name)):
        with open(os.path.join(name, file)) as rows:
            lines = rows.read().splitlines()[1:]
        print(f"    {file}: {len(lines)} rows, instances {sorted({line.split(',')[1] for line in lines})}")
END
venv/bin/python second.py >seen

cat >expected <<'END'
even: 6 of instance 0, 6 of instance 1
    BARO0-even.csv: 6 rows, instances ['0']
    BARO1-even.csv: 6 rows, instances ['1']
late: 9 of instance 0, 3 of instance 1
    BARO-late.csv: 12 rows, instances ['0', '1']
gap: 6 of instance 0, 6 of instance 2
    BARO0-gap.csv: 6 rows, instances ['0']
    BARO1-gap.csv: 0 rows, instances []
END
diff expected seen || { echo "CHANGED: pybinlog-second-sensor" >&2; exit 1; }
echo "PASS: of instances 0 and 2 the latter is in no file"
