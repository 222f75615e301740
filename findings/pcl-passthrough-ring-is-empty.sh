#!/bin/sh
# SPDX-License-Identifier: MIT
# pcl_passthrough_filter by the ring of a laser or by the time gives an empty cloud and success, and clouds joined by
# pcl_concatenate_points_pcd all get the viewpoint of the last.
#
# Version:   pcl_passthrough_filter and pcl_concatenate_points_pcd of pcl-tools 1.13.0 (Debian 12).
# Expected:  -field ring -min 2 -max 3 leaves the points of the rings 2 and 3, and nan in the place of the others, as it
#           does where the ring is a float. Clouds with two viewpoints are moved to one, or refused.
# Behaviour: Only fields of float with four bytes can be compared. With an integer or a double an error is printed on
#           the way, a file with no points is saved and the exit code is 0. Joined clouds keep their coordinates and
#           take the VIEWPOINT of the last file.
# Hurts:     Anyone who cuts rings or spans of time out of a cloud in a script, and takes an empty file for an empty
#           scene.
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

cloud() {
    cat <<END
# .PCD v0.7
VERSION 0.7
FIELDS x y z ring
SIZE 4 4 4 $2
TYPE F F F $1
COUNT 1 1 1 1
WIDTH 4
HEIGHT 1
VIEWPOINT $3 0 0 1 0 0 0
POINTS 4
DATA ascii
1 0 0 1
2 0 0 2
3 0 0 3
4 0 0 4
END
}
points() {
    strings "$1" | sed -n 's/^POINTS //p'
}
{
    for type in "F 4" "F 8" "U 1" "U 2" "I 4"; do
        cloud $type 0 >in.pcd
        code=0
        run pcl_passthrough_filter in.pcd out.pcd -field ring -min 2 -max 3 >out.log 2>&1 || code=$?
        echo "type $type: points $(points out.pcd), exit code $code"
    done
    cloud F 4 1 >one.pcd
    cloud F 4 5 >five.pcd
    run pcl_concatenate_points_pcd one.pcd five.pcd >/dev/null 2>&1
    echo "joined, from 1 and from 5: points $(points output.pcd), $(strings output.pcd | grep VIEWPOINT)"
} >seen

cat >expected <<'END'
type F 4: points 4, exit code 0
type F 8: points 0, exit code 0
type U 1: points 0, exit code 0
type U 2: points 0, exit code 0
type I 4: points 0, exit code 0
joined, from 1 and from 5: points 8, VIEWPOINT 5 0 0 1 0 0 0
END
diff expected seen || { echo "CHANGED: pcl-passthrough-ring-is-empty" >&2; exit 1; }
echo "PASS: rings 2 and 3 of integers are no points"
