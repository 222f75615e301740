#!/bin/sh
# SPDX-License-Identifier: MIT
# A UAM-05LP without an error has the error code 64 in uam_05lp, which documents 0, and a stream in a for loop without
# with has no scans.
#
# Version:   uam-05lp 0.2.0.
# Expected:  error_code is 0 when there is no error, as the description of the class says, and an iterator of scans
#            iterates or raises.
# Behaviour: The offset of 0x40 that error codes have is added to the zero, too. The log of errors leaves zeros out
#            before that, the two states do not. A scanner that was not entered by with ends at once, like a stream
#            that is over.
# Hurts:     Anyone who stops a vehicle on error_code != 0: it never starts. Anyone who loops over iter_distance():
#            nothing happens, and nothing is wrong.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            uam-05lp==0.2.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >safety.py <<'END'
from uam_05lp import UAM05LP
from uam_05lp._crc import compute_crc


def frame(text):
    """A message of the scanner without its last byte."""
    body = f"{len(text) + 10:04X}{text}"
    return b"\x02" + body.encode() + f"{compute_crc(body.encode()):04X}".encode()


class Scanner:
    """A healthy scanner."""

    is_open = True

    def send(self, order):
        self.order = order[5:9].decode()

    def receive_frame(self, timeout):
        started = self.order in ("AR02", "AR03")
        self.order = "AR03" if self.order == "AR03" else "AR00"
        scan = "000000" + "0011" + "0" * 23 + "000000" + "03E8" * 1081
        return frame(self.order + "00" + ("" if started else scan))


scanner = UAM05LP(transport=Scanner())
safety = scanner.get_distance().safety
print("error detected:", safety.error_detected, "code:", safety.error_code)
print("scans in a for loop:", sum(1 for _ in zip(range(5), scanner.iter_distance())))
with scanner.iter_distance() as stream:
    print("scans in a for loop inside with:", sum(1 for _ in zip(range(5), stream)))
END
venv/bin/python safety.py >seen

cat >expected <<'END'
error detected: False code: 64
scans in a for loop: 0
scans in a for loop inside with: 5
END
diff expected seen || { echo "CHANGED: uam-05lp-no-error-is-64" >&2; exit 1; }
echo "PASS: no error has the code 64"
