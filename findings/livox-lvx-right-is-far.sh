#!/bin/sh
# SPDX-License-Identifier: MIT
# A point one metre to the right of a Livox laser is 4294966 m to the left in livox-lvx, which reads and writes
# coordinates without a sign.
#
# Version:   livox-lvx 0.2.1.
# Expected:  x, y and z are read with their signs, as the format has them, in millimetres.
# Behaviour: All three are unsigned in all kinds of points: -1000 is read as 4294966296. A point with a negative
#            coordinate cannot be written: struct.error. The file that clean_file makes has the right bytes, since it
#            does not look at them.
# Hurts:     Anyone who measures or plots such a scan: half of the room is 4295 km away.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            livox-lvx==0.2.1 \
            progress==1.6.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >points.py <<'END'
import io
import struct

from lvx.lvx import LvxDeviceInfo, LvxExtendedRawPoint, LvxFileReader, LvxFileWriter, LvxHeader

points = [(2000, 1000, 300), (2000, -1000, -300)]  # mm: ahead to the left and above, ahead to the right and below
body = b"".join(struct.pack("<3i2B", *point, 80, 0) for point in points) + bytes(14 * 94)
package = struct.pack("<5BIBBQ", 0, 5, 0, 0, 0, 0, 1, 2, 0) + body  # of 96 extended points
file = io.BytesIO()
LvxFileWriter(LvxHeader(devices=[LvxDeviceInfo()]), file)
begin = file.tell()
file.write(struct.pack("<3Q", begin, begin + 24 + len(package), 0) + package)

for frame in LvxFileReader(file):
    for (x, y, z), read in zip(points, frame.packages[0].points):
        print(f"x {x}, y {y}, z {z} mm: read as {read.x}, {read.y}, {read.z}")
try:
    LvxExtendedRawPoint(*points[1], 80, 0).write_to(io.BytesIO())
except struct.error as error:
    print("written:", error)
END
venv/bin/python points.py >seen

cat >expected <<'END'
x 2000, y 1000, z 300 mm: read as 2000, 1000, 300
x 2000, y -1000, z -300 mm: read as 2000, 4294966296, 4294966996
written: argument out of range
END
diff expected seen || { echo "CHANGED: livox-lvx-right-is-far" >&2; exit 1; }
echo "PASS: 1 m to the right is 4295 km to the left"
