#!/bin/sh
# SPDX-License-Identifier: MIT
# The depth of an echo sounder is missing from the JSON of gpsdecode until there is a position in three dimensions.
#
# Version:   gpsdecode of gpsd-clients 3.22 (Debian 12).
# Expected:  A sentence DBT or DPT with a valid checksum gives an object with its depth.
# Behaviour: DBT without a fix gives an object without depth. The same sentence after a position with height gives the
#            depth, in the object of the position. DPT gives nothing in either case.
# Hurts:     Anyone who reads a depth sounder by gpsd indoors, under water or in a tank: the sensor seems dead.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    apt-get -qq -s install --no-install-recommends gpsd-clients=3.22-4.1+deb12u1 >plan &&
        sed -n 's/^Inst \([^ ]*\).*/\1/p' plan | xargs -r apt-get -qq download &&
        find . -name '*.deb' -exec dpkg -x {} debian \; || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }
PATH="$PWD/debian/usr/bin:$PWD/debian/usr/sbin:$PATH"
LD_LIBRARY_PATH="$PWD/debian/usr/lib/$(uname -m)-linux-gnu"
export PATH LD_LIBRARY_PATH

cat >sentences.py <<'END'
import functools
import operator

FIX = ["GPGGA,{0}.00,5130.000,N,00015.000,W,1,08,0.9,45.4,M,46.9,M,,", "GPRMC,{0}.00,A,5130.000,N,00015.000,W,0.0,0.0,141123,,,A"]


def nmea(lines):
    """Return sentences with their checksums."""
    sums = [functools.reduce(operator.xor, line.encode()) for line in lines]
    return "".join(f"${line}*{xor:02X}\r\n" for line, xor in zip(lines, sums, strict=True))


for sounder in ("SDDBT,7.9,f,2.4,M,1.3,F", "SDDPT,2.4,0.0,10.0"):
    name = sounder[2:5]
    open(name + "-alone", "w").write(nmea([sounder] * 5))
    fixes = [[line.format(second) for line in FIX] + [sounder] for second in range(120000, 120005)]
    open(name + "-with-fix", "w").write(nmea(sum(fixes, [])))
END
python3 sentences.py
for file in DBT-alone DBT-with-fix DPT-alone DPT-with-fix; do
    gpsdecode <$file | tr -d '' >$file.json
    echo "$file: depth 2.4 m in some object: $(grep -c '"depth":2.4' $file.json | sed 's/^[1-9].*/yes/; s/^0/no/')"
done >seen
echo "DBT-alone: $(sort -u DBT-alone.json)" >>seen

cat >expected <<'END'
DBT-alone: depth 2.4 m in some object: no
DBT-with-fix: depth 2.4 m in some object: yes
DPT-alone: depth 2.4 m in some object: no
DPT-with-fix: depth 2.4 m in some object: no
DBT-alone: {"class":"TPV","device":"stdin","mode":0}
END
diff expected seen || { echo "CHANGED: gpsdecode-depth-without-fix" >&2; exit 1; }
echo "PASS: a depth is shown beside a position only, one of DPT never"
