#!/bin/sh
# SPDX-License-Identifier: MIT
# The time of each point is 1.7e+09 after pcl_convert_pcd_ascii_binary or pcl_pcd2ply has written it as text, and PLY
# stands at the origin.
#
# Version:   pcl_convert_pcd_ascii_binary and pcl_pcd2ply of pcl-tools 1.13.0 (Debian 12).
# Expected:  A field of eight bytes with 1700000000.123456 keeps its digits as text, or at least its seconds. The PLY
#           file has the place of the sensor in its camera.
# Behaviour: PCD has about seven digits as text, PLY about eight. All points of a minute share one time, and a
#           coordinate of a map such as 5412345.5 is moved to the next metre. The camera of the PLY file is at 0 0 0 and
#           looks along the axes, whatever the VIEWPOINT of the PCD file. Binary PCD keeps all of it.
# Hurts:     Anyone who converts to text for a script, a diff or a review: the points of a turning laser have no times
#           any more, and a map moves.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    apt-get -qq -s install --no-install-recommends pcl-tools=1.13.0+dfsg-3 >plan &&
        sed -n 's/^Inst \([^ ]*\).*/\1/p' plan | xargs -r apt-get -qq download &&
        find . -name '*.deb' -exec dpkg -x {} debian \; || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }
libraries=$(find "$PWD/debian" -name '*.so*' -printf '%h\n' | sort -u | paste -sd:)
run() {
    program=$1
    shift
    LD_LIBRARY_PATH="$libraries" "$folder/debian/usr/bin/$program" "$@"
}

cat >ring.pcd <<'END'
# .PCD v0.7
VERSION 0.7
FIELDS x y z stamp
SIZE 4 8 4 8
TYPE F F F F
COUNT 1 1 1 1
WIDTH 2
HEIGHT 1
VIEWPOINT 1 2 0.5 0.7071068 0 0 0.7071068
POINTS 2
DATA ascii
1.5 5412345.5 0 1700000000.123456
2.5 5412346.25 0 1700000059.625
END
run pcl_convert_pcd_ascii_binary ring.pcd binary.pcd 1 >/dev/null 2>&1
run pcl_convert_pcd_ascii_binary binary.pcd text.pcd 0 >/dev/null 2>&1
run pcl_pcd2ply -format 0 ring.pcd text.ply >/dev/null 2>&1
python3 - >seen <<'END'
import struct
from pathlib import Path

binary = Path("binary.pcd").read_bytes().split(b"DATA binary\n")[1]
for number in range(2):
    print("binary:", *struct.unpack_from("<fdfd", binary, 24 * number))
text = Path("text.pcd").read_text()
print("PCD:", *text.split("DATA ascii\n")[1].splitlines(), sep="\n  ")
print([line for line in text.splitlines() if line.startswith("VIEWPOINT")][0])
lines = Path("text.ply").read_text().split("end_header\n")[1].splitlines()
print("PLY:", *lines[:2], sep="\n  ")
print("camera of the PLY:", *lines[-1].split()[:12])
END

cat >expected <<'END'
binary: 1.5 5412345.5 0.0 1700000000.123456
binary: 2.5 5412346.25 0.0 1700000059.625
PCD:
  1.5 5412346 0 1.7e+09
  2.5 5412346 0 1.7e+09
VIEWPOINT 1 2 0.5 0.707107 0 0 0.707107
PLY:
  1.5 5412345.5 0 1.7e+09
  2.5 5412346.2 0 1.7000001e+09
camera of the PLY: 0 0 0 1 0 0 0 1 0 0 0 1
END
diff expected seen || { echo "CHANGED: pcl-ascii-times" >&2; exit 1; }
echo "PASS: 1700000000.123456 and 1700000059.625 are 1.7e+09"
