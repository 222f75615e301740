#!/bin/sh
# SPDX-License-Identifier: MIT
# Of a BLF file by python-can tshark shows no error frame, and CAN FD frames without their flags.
#
# Version:   python-can 4.6.1, tshark 4.0.17 (Debian 12).
# Expected:  BLF is opened, so each object of CAN is shown: an error as an error, FD with its switch of the bit rate.
# Behaviour: The error frame is not there at all, the numbers close up. An FD frame is one of "CAN" with 12 bytes and
#            no flag; the same frame from a candump log is CANFD.
# Hurts:     Anyone who looks for errors of a bus, or for a wrong bit rate, in Wireshark: there are none.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            python-can==4.6.1 || return 1
    apt-get -qq -s install tshark=4.0.17-0+deb12u3 >plan &&
        sed -n 's/^Inst \([^ ]*\).*/\1/p' plan | xargs -r apt-get -qq download &&
        find . -name '*.deb' -exec dpkg -x {} debian \; || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }
PATH="$PWD/debian/usr/bin:$PWD/debian/usr/sbin:$PATH"
LD_LIBRARY_PATH="$PWD/debian/usr/lib/$(uname -m)-linux-gnu"
export PATH LD_LIBRARY_PATH

cat >write.py <<'END'
import can

for name in ("bus.blf", "bus.log"):
    with can.Logger(name) as log:
        log(can.Message(timestamp=1.0, arbitration_id=0x80, is_extended_id=False, is_error_frame=True, data=bytes(8), channel=0))
        log(can.Message(timestamp=2.0, arbitration_id=1, is_extended_id=False, is_fd=True, bitrate_switch=True, data=bytes(12), channel=0))
END
venv/bin/python write.py
sed -i 's/ R$//' bus.log
for name in bus.log bus.blf; do
    echo "$name:"
    tshark -r $name -T fields -e can.flags.err -e frame.protocols -e canfd.flags.brs -e can.len -E separator=, 2>/dev/null
done >seen

cat >expected <<'END'
bus.log:
1,exported_pdu:can,,8
,exported_pdu:canfd:data,1,12
bus.blf:
0,can:data,,12
END
diff expected seen || { echo "CHANGED: tshark-blf-error-and-fd" >&2; exit 1; }
echo "PASS: one of two frames of a BLF is shown, and as classic CAN"
