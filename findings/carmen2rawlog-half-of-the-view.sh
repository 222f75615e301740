#!/bin/sh
# SPDX-License-Identifier: MIT
# A laser of 180 degrees sees 90 of them after carmen2rawlog, and a line that mends the front laser leaves the rear
# one as it was.
#
# Version:   carmen2rawlog and rawlog-edit of mrpt-apps 2.5.8 (Debian 12).
# Expected:  A scan of 180 readings of the classic log covers half a turn, one reading a degree, as its hardware did.
# Behaviour: A step is half a degree unless a line with PARAM laser_front_laser_resolution says otherwise, and one with
#           laser_rear_laser_resolution for the other laser: a log that was cut to its scans has neither. Walls at the
#           sides come to lie at 45 degrees. ROBOTLASER1 tells its own angles and is right.
# Hurts:     Anyone who maps a classic data set with MRPT. Write both lines with 1.0 before the first scan.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    apt-get -qq -s install --no-install-recommends mrpt-apps=1:2.5.8+ds-2 >plan &&
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

cat >log.py <<'END'
import sys

RANGES = " ".join(["2.00"] * 180)
TAIL = "0 0 0 0 0 0 1100000000.0 robot 1100000000.0"
for laser in sys.argv[1:]:
    print(f"PARAM laser_{laser}_laser_resolution 1.0")
print(f"FLASER 180 {RANGES} {TAIL}")
print(f"RLASER 180 {RANGES} {TAIL}")
print(f"ROBOTLASER1 0 -1.5707963 3.1415927 0.0174533 20 0.01 0 180 {RANGES} 0 0 0 0 0 0 0 0 0 0 0 0 1100000000.0 robot 0")
END
for lines in "" front "front rear"; do
    python3 log.py $lines >carmen.log
    run carmen2rawlog -q -w -i carmen.log -o carmen.rawlog >/dev/null
    echo "resolution told: ${lines:-not}"
    run rawlog-edit -i carmen.rawlog --describe 2>/dev/null | awk -F"'" '
        /^Sensor label/ { label = $2 }
        /field-of-view/ { sub(".*: ", ""); print "  " label ": " $0 }'
done >seen

cat >expected <<'END'
resolution told: not
  FLASER: 90.0 deg
  RLASER: 90.0 deg
  ROBOTLASER1: 180.0 deg
resolution told: front
  FLASER: 180.0 deg
  RLASER: 90.0 deg
  ROBOTLASER1: 180.0 deg
resolution told: front rear
  FLASER: 180.0 deg
  RLASER: 180.0 deg
  ROBOTLASER1: 180.0 deg
END
diff expected seen || { echo "CHANGED: carmen2rawlog-half-of-the-view" >&2; exit 1; }
echo "PASS: 180 readings cover 90 degrees"
