#!/bin/sh
# SPDX-License-Identifier: MIT
# The Fletcher-16 checksum of srec_cat is little-endian where big-endian is asked for, and the other way round.
#
# Version:   srec_cat of srecord 1.64 (Debian 12).
# Expected:  Fletcher-16 of "abcde" is c8f0, so the big-endian filter inserts c8 f0. Its CRC-16 filters keep to their
#            names.
# Behaviour: The big-endian filter inserts f0 c8, the little-endian one c8 f0.
# Hurts:     Anyone who has a boot loader check an image that srec_cat has sealed: every image is refused.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    apt-get -qq -s install srecord=1.64-3 >plan &&
        sed -n 's/^Inst \([^ ]*\).*/\1/p' plan | xargs -r apt-get -qq download &&
        find . -name '*.deb' -exec dpkg -x {} debian \; || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }
PATH="$PWD/debian/usr/bin:$PWD/debian/usr/sbin:$PATH"
LD_LIBRARY_PATH="$PWD/debian/usr/lib/$(uname -m)-linux-gnu"
export PATH LD_LIBRARY_PATH

printf abcde >text.bin
for order in big little; do
    echo "fletcher $order $(srec_cat text.bin -binary -fletcher16-$order-endian 16 -o - -hex-dump | tail -1 | cut -c11-15)"
    echo "crc16 $order $(srec_cat text.bin -binary -crc16-$order-endian 16 -xmodem -o - -hex-dump | tail -1 | cut -c11-15)"
done >seen
printf abcde >plain.bin
python3 - >>seen <<'END'
import binascii

low = high = 0
for byte in open("plain.bin", "rb").read():
    low = (low + byte) % 255
    high = (high + low) % 255
print(f"by hand: fletcher {high:02x}{low:02x} crc16 {binascii.crc_hqx(b'abcde', 0):04x}")
END

cat >expected <<'END'
fletcher big F0 C8
crc16 big 3E E1
fletcher little C8 F0
crc16 little E1 3E
by hand: fletcher c8f0 crc16 3ee1
END
diff expected seen || { echo "CHANGED: srecord-fletcher-order" >&2; exit 1; }
echo "PASS: fletcher16-big-endian inserts F0 C8 for the sum c8f0"
