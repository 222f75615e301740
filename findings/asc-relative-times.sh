#!/bin/sh
# SPDX-License-Identifier: MIT
# An ASC file that declares its times as relative is read by python-can as if they were absolute.
#
# Version:   python-can 4.6.1.
# Expected:  "timestamps relative" means since the frame before: three frames one second apart are at 0, 1 and 2 s.
# Behaviour: The reader parses the word, stores it, and does not use it: the frames are at 0, 1 and 1 s.
# Hurts:     Anyone who computes rates or latencies of such a file: all frames lie within the longest pause.
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

FRAMES = "".join(f"   {min(n, 1)}.000000 1  100             Rx   d 1 0{n}\n" for n in range(4))
open("bus.asc", "w").write("date Tue Nov 14 22:13:20 2023\nbase hex  timestamps relative\nno internal events logged\n" + FRAMES)
reader = can.ASCReader("bus.asc")
print(*(message.timestamp for message in reader))
print(reader.timestamps_format)
END

cat >expected <<'END'
0.0 1.0 1.0 1.0
relative
END
diff expected seen || { echo "CHANGED: asc-relative-times" >&2; exit 1; }
echo "PASS: four frames one second apart are read at 0, 1, 1 and 1 s"
