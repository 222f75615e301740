#!/bin/sh
# SPDX-License-Identifier: MIT
# pysicktim reads hexadecimal numbers in base 32: a laser that scans from -45 degrees at 15 Hz is reported at 55.48 Hz
# from 53201502 degrees.
#
# Version:   pysicktim 0.0.9, pyusb 1.3.1.
# Expected:  The numbers of a SICK telegram are hexadecimal, angles signed of 32 bits in ten thousandths of a degree,
#            as the package itself reads their neighbours.
# Behaviour: The angles of the configuration, frequency and uptime of a scan are read in base 32. Every refusal is
#            reported as error 15, since the digit is taken from the word sFA.
# Hurts:     Anyone who computes bearings or times from what the laser reports of itself.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pysicktim==0.0.9 \
            pyusb==1.3.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >laser.py <<'END'
import usb.core


class Laser:
    """A TIM561 on USB: answers by the name of what is asked."""

    answers = {
        "LMPscancfg": "sRA LMPscancfg 5DC 1 D05 FFF92230 225510",
        "LMDscandata": "sRA LMDscandata 1 1 1078AAA 0 0 3C23 3C25 426E6678 426E7BBC 0 0 1 0 0 5DC A2 0 1 DIST1 3F800000 "
        "00000000 FFF92230 D05 3 64 C8 12C 0 0 0 0 0 0",
    }

    def write(self, endpoint, order, timeout=None):
        self.order = order

    def read(self, endpoint, size, timeout=None):
        answer = next(text for name, text in self.answers.items() if name in self.order)
        return b"\x02" + answer.encode() + b"\x03"

    def __getattr__(self, name):
        return lambda *arguments, **named: None


usb.core.find = lambda *arguments, **named: Laser()
import pysicktim

frequency, sectors, step, start, stop = pysicktim.scancfg()
try:
    pysicktim.scan()
finally:
    print(f"5DC hundredths of a Hz are 15: read as {frequency}, and in a scan as {pysicktim.scan.scan_freq}")
print(f"426E6678 microseconds are 1114.5 s: read as {pysicktim.scan.uptime / 1e6:.1f}")
print(f"D05 ten thousandths of a degree are 0.3333: read as {step}")
print(f"FFF92230 and 225510 are -45 and 225 degrees: read as {start:.0f} and {stop:.0f}")
print("error 2, METHODIN_UNKNOWNINDEX:", pysicktim.check_error("sFA 2")[0])
END
venv/bin/python laser.py >seen

cat >expected <<'END'
5DC hundredths of a Hz are 15: read as 15.0, and in a scan as 55.48
426E6678 microseconds are 1114.5 s: read as 139802.6
D05 ten thousandths of a degree are 0.3333: read as 0.3333
FFF92230 and 225510 are -45 and 225 degrees: read as 53201502 and 6938
error 2, METHODIN_UNKNOWNINDEX: Sopas_Error_EVENTREG_UNKNOWNINDEX
END
diff expected seen || { echo "CHANGED: pysicktim-base-32" >&2; exit 1; }
echo "PASS: 15 Hz are read as 55.48"
