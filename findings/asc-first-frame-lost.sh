#!/bin/sh
# SPDX-License-Identifier: MIT
# The ASC reader of python-can swallows the first frame where no line about internal events stands before it.
#
# Version:   python-can 4.6.1.
# Expected:  A frame is read, whatever lines of the header are there: date and base alone tell all that is needed.
# Behaviour: The header ends with a line about internal events; the first line that is not of the header is discarded
#            with it.
# Hurts:     Anyone who writes ASC with a script of three lines, or has cut a log to a window: the frame that starts
#            it all is missing, without a word.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            python-can==4.6.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
import can

FRAMES = "".join(f"   {n}.000000 1  {n + 0x100:X}             Rx   d 1 01\n" for n in range(3))
HEADER = "date Tue Nov 14 22:13:20 2023\nbase hex  timestamps absolute\n"
for title, more in (("with it:", "no internal events logged\n"), ("without:", "")):
    open("bus.asc", "w").write(HEADER + more + FRAMES)
    print(title, *(hex(message.arbitration_id) for message in can.ASCReader("bus.asc")))
END

cat >expected <<'END'
with it: 0x100 0x101 0x102
without: 0x101 0x102
END
diff expected seen || { echo "CHANGED: asc-first-frame-lost" >&2; exit 1; }
echo "PASS: of frames 100, 101, 102 the reader returns 101 and 102"
