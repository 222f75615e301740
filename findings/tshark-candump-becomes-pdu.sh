#!/bin/sh
# SPDX-License-Identifier: MIT
# A candump log that tshark saves as a capture is no CAN capture any more.
#
# Version:   tshark 4.0.17 (Debian 12).
# Expected:  CAN frames saved as pcap have the link type 227 (SocketCAN), as those captured from an interface do.
# Behaviour: They have 252, exported PDUs of Wireshark: before each frame stands the name of a dissector,
#            "can-hostendian", and the identifier is little-endian.
# Hurts:     Anyone who converts logs to pcap for other tools: what reads link type 227 refuses them, only Wireshark
#            itself shows them as before.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    apt-get -qq -s install tshark=4.0.17-0+deb12u3 >plan &&
        sed -n 's/^Inst \([^ ]*\).*/\1/p' plan | xargs -r apt-get -qq download &&
        find . -name '*.deb' -exec dpkg -x {} debian \; || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }
PATH="$PWD/debian/usr/bin:$PWD/debian/usr/sbin:$PATH"
LD_LIBRARY_PATH="$PWD/debian/usr/lib/$(uname -m)-linux-gnu"
export PATH LD_LIBRARY_PATH

printf '(1.000000) can0 123#0102\n' >bus.log
tshark -r bus.log -F pcap -w bus.pcap 2>/dev/null
{
    tshark -r bus.pcap -T fields -e can.id -e can.len 2>/dev/null
    echo "link type $(od -An -tu4 -j20 -N4 bus.pcap | tr -d ' ')"
    echo "identifier $(tail -c 16 bus.pcap | od -An -tx1 -N4 | tr -d ' ')"
    grep -ao can-hostendian bus.pcap
} >seen

cat >expected <<'END'
291	2
link type 252
identifier 23010000
can-hostendian
END
diff expected seen || { echo "CHANGED: tshark-candump-becomes-pdu" >&2; exit 1; }
echo "PASS: the capture has the link type 252 and the identifier 23010000"
