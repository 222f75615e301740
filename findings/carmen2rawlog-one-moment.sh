#!/bin/sh
# SPDX-License-Identifier: MIT
# All records of a CARMEN log have one time after carmen2rawlog, the time of the conversion.
#
# Version:   carmen2rawlog and rawlog-edit of mrpt-apps 2.5.8 (Debian 12).
# Expected:  A log of 42 s becomes a rawlog of 42 s: each line has a time, and rawlogs have one per observation.
# Behaviour: The times of the lines are read over. Every observation gets the time at which the tool was started, so the
#           recording has no duration, its rate is infinite and the file of the ground truth has one pose of five.
#           Odometry is taken from the scans, lines of ODOM and SONAR are left out without a word.
# Hurts:     Anyone who runs the classic data sets through MRPT with motion models, filters by age or comparisons by
#           time. Take the times out of the log; the order of the scans stays.
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
print("PARAM laser_front_laser_resolution 1.0")
for step in range(5):
    seconds = 1100000000 + 10.5 * step
    print(f"ODOM {step} 0 0 0 0 0 {seconds:.3f} robot {seconds:.3f}")
    print(f"SONAR 2 1.5 2.5 2 0.1 0 0 0.1 0 90 {step} 0 0 {seconds:.3f} robot {seconds:.3f}")
    print("FLASER 180", *["2.00"] * 180, f"{step} 0 0 {step} 0 0 {seconds:.3f} robot {seconds:.3f}")
END
python3 log.py >carmen.log
before=$(date +%s)
run carmen2rawlog -q -i carmen.log -o carmen.rawlog >/dev/null
run rawlog-edit -i carmen.rawlog --list-timestamps -o times.txt >/dev/null 2>&1
[ -e times.txt ] || mv out.txt times.txt
{
    echo "lines of the log: $(grep -cv PARAM carmen.log), records of the rawlog: $(wc -l <times.txt)"
    echo "different times in the log: $(awk '/FLASER/ { print $(NF - 2) }' carmen.log | sort -u | wc -l), in the rawlog: $(cut -d' ' -f1 times.txt | sort -u | wc -l)"
    echo "seconds from the conversion to the first record, in hundreds: $(awk -v before="$before" 'NR == 1 { print int(($1 - before) / 100) }' times.txt)"
    echo "labels: $(cut -d' ' -f2 times.txt | sort -u | xargs)"
    echo "poses of the ground truth: $(grep -cv '^%' carmen.gt.txt)"
} >seen

cat >expected <<'END'
lines of the log: 15, records of the rawlog: 10
different times in the log: 5, in the rawlog: 1
seconds from the conversion to the first record, in hundreds: 0
labels: FLASER ODOMETRY
poses of the ground truth: 1
END
diff expected seen || { echo "CHANGED: carmen2rawlog-one-moment" >&2; exit 1; }
echo "PASS: five scans over 42 s are one moment, that of the conversion"
