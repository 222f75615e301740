#!/bin/sh
# SPDX-License-Identifier: MIT
# fdtput stores 5000000000 as 705032704, 010 as 8 and 12abc as 12 in a device tree, without a word.
#
# Version:   fdtput of device-tree-compiler 1.6.1 (Debian 12).
# Expected:  A number that does not fit its cell, or is none, is refused, as dtc refuses it in a source.
# Behaviour: It is cut to its low 32 bits, or where its digits end. A zero in front means octal, in a list of decimals
#            too. The exit code is 0.
# Hurts:     Anyone who patches addresses, sizes or serial numbers into a blob from a script: more than 4 GiB of memory
#            become less than 1.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    apt-get -qq -s install device-tree-compiler=1.6.1-4+b1 >plan &&
        sed -n 's/^Inst \([^ ]*\).*/\1/p' plan | xargs -r apt-get -qq download &&
        find . -name '*.deb' -exec dpkg -x {} debian \; || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }
PATH="$PWD/debian/usr/bin:$PWD/debian/usr/sbin:$PATH"
LD_LIBRARY_PATH="$PWD/debian/usr/lib/$(uname -m)-linux-gnu"
export PATH LD_LIBRARY_PATH

printf '/dts-v1/;\n/ { };\n' | dtc -q -I dts -O dtb -o board.dtb -
for value in 115200 5000000000 010 12abc; do
    fdtput -t i board.dtb / value "$value" && code=0 || code=$?
    echo "$value: $(fdtget -t i board.dtb / value), exit code $code"
done >seen 2>&1
fdtput -t bi board.dtb / value 300
echo "300 in a byte: $(fdtget -t bi board.dtb / value)" >>seen
for value in 5000000000 12abc; do
    printf '/dts-v1/;\n/ { value = <%s>; };\n' "$value" | dtc -q -I dts -O dtb -o source.dtb - 2>/dev/null || echo "dtc refuses $value" >>seen
done

cat >expected <<'END'
115200: 115200, exit code 0
5000000000: 705032704, exit code 0
010: 8, exit code 0
12abc: 12, exit code 0
300 in a byte: 44
dtc refuses 5000000000
dtc refuses 12abc
END
diff expected seen || { echo "CHANGED: fdtput-cuts-numbers" >&2; exit 1; }
echo "PASS: 5000000000 becomes 705032704"
