#!/bin/sh
# SPDX-License-Identifier: MIT
# A point without an echo, nan nan nan, is a point at the sensor after convertcloud, and colours that it read are
# announced and not written.
#
# Version:   convertcloud 0.1.0, pypcd4 1.5.1, numpy 2.4.6.
# Expected:  Points without coordinates are left out or stay nan. A file has the fields that its header tells.
# Behaviour: A line of an XYZ file that starts with nan becomes 0 0 0. One with colours becomes a PCD file whose header
#            has four fields and whose lines have three numbers. Without a COUNT line none of its PCD files is read by
#            pypcd4. Coordinates of a map go through 32 bits: 5400000.25 is written as 5400000.0.
# Hurts:     Anyone who converts scans with lost echoes: each of them is an obstacle at the sensor.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            convertcloud==0.1.0 \
            numpy==2.4.6 \
            pypcd4==1.5.1 \
            pydantic==2.14.4 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >convert.py <<'END'
import contextlib
import io
from pathlib import Path

from convertcloud.converter import Converter
from pypcd4 import PointCloud


def convert(text):
    """Write an XYZ file, convert it to PCD and return that."""
    Path("scan.xyz").write_text(text)
    with contextlib.redirect_stdout(io.StringIO()):
        converter = Converter()
        converter.load_points("scan.xyz")
        converter.convert("scan.pcd")
    return Path("scan.pcd").read_text().splitlines()


print(*convert("1.5 0.5 0.25\nnan nan nan\n2.0 0.5 0.25\n")[-3:], sep="; ")
lines = convert("1.5 0.5 0.25 255 0 0\n2.0 0.5 0.25 0 255 0\n")
print(lines[2], "|", *lines[-2:], sep="; ")
try:
    PointCloud.from_path("scan.pcd")
except ValueError as error:
    print("pypcd4:", error.errors()[0]["loc"][0], "of the header:", error.errors()[0]["msg"])
print(convert("500000.12 5400000.25 200.5\n")[-1])
END
venv/bin/python convert.py >seen

cat >expected <<'END'
1.5 0.5 0.25; 0.0 0.0 0.0; 2.0 0.5 0.25
FIELDS x y z rgb; |; 1.5 0.5 0.25; 2.0 0.5 0.25
pypcd4: count of the header: Field required
500000.125 5400000.0 200.5
END
diff expected seen || { echo "CHANGED: convertcloud-no-echo-is-here" >&2; exit 1; }
echo "PASS: nan nan nan is 0 0 0"
