#!/bin/sh
# SPDX-License-Identifier: MIT
# tshark reads candump logs, but not those of python-can, whose lines end with R or T.
#
# Version:   python-can 4.6.1, tshark 4.0.17 (Debian 12).
# Expected:  Both call the format "candump -L", so what one writes the other opens.
# Behaviour: python-can ends each line with the direction (newer candump does on request, -x). One such line is
#            enough: tshark finds no format it knows. Without the letter the same file is read.
# Hurts:     Anyone who records with python-can and analyses with Wireshark.
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

with can.CanutilsLogWriter("bus.log") as log:
    for seconds in (0, 1):
        log(can.Message(timestamp=1.0 + seconds, arbitration_id=1, is_extended_id=False, data=b"\1", channel=0))
END
venv/bin/python write.py
sed 's/ R$//' bus.log >plain.log
for name in bus plain; do
    echo "$name.log: $(tshark -r $name.log -T fields -e can.id 2>/dev/null | wc -l) frames"
done >seen

cat >expected <<'END'
bus.log: 0 frames
plain.log: 2 frames
END
diff expected seen || { echo "CHANGED: tshark-refuses-direction" >&2; exit 1; }
echo "PASS: 0 frames of a log with directions, 2 without them"
