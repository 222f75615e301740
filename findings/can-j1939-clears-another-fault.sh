#!/bin/sh
# SPDX-License-Identifier: MIT
# A request of can-j1939 to clear fault 520200 asks to clear fault 61448: DM22 loses all bits of a number above the
# sixteenth.
#
# Version:   can-j1939 2.0.12, python-can 4.6.1.
# Expected:  The number of a fault has 19 bits in DM22, as it has in DM1 of the same package.
# Behaviour: The upper three bits are shifted down by 22 places instead of 11, so nothing is left of them. DM1 packs
#            and unpacks them rightly.
# Hurts:     Anyone who clears faults of a sensor by its proprietary number, all of which are above 516095: another
#            fault is cleared, or none, and the other node is right to refuse.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            can-j1939==2.0.12 \
            python-can==4.6.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >dm22.py <<'END'
from j1939 import DTC, Dm22


class Application:
    """Keep what is sent."""

    def send_pgn(self, page, pdu_format, pdu_specific, priority, data):
        self.sent = list(data)


application = Application()
for spn in (100, 65535, 65536, 520200):
    Dm22(application).request_clear_act_dtc(0x80, spn, 2)
    low, middle, high = application.sent[5:8]
    asked = low | middle << 8 | (high & 0xE0) << 11
    in_dm1 = DTC(dtc=DTC(spn=spn, fmi=2).dtc).spn
    print(f"fault {spn}: DM1 has {in_dm1}, DM22 asks for {asked} with FMI {high & 0x1F}")
END
venv/bin/python dm22.py >seen

cat >expected <<'END'
fault 100: DM1 has 100, DM22 asks for 100 with FMI 2
fault 65535: DM1 has 65535, DM22 asks for 65535 with FMI 2
fault 65536: DM1 has 65536, DM22 asks for 0 with FMI 2
fault 520200: DM1 has 520200, DM22 asks for 61448 with FMI 2
END
diff expected seen || { echo "CHANGED: can-j1939-clears-another-fault" >&2; exit 1; }
echo "PASS: 520200 is asked for as 61448"
