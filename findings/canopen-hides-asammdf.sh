#!/bin/sh
# SPDX-License-Identifier: MIT
# With canopen installed, python-can denies that asammdf is there if asammdf was imported first.
#
# Version:   canopen 2.4.1 beside python-can 4.6.1, asammdf 8.8.28, canmatrix 1.2.
# Expected:  The order of two imports does not matter, nor does a third package that the program never uses.
# Behaviour: asammdf imports canmatrix, which imports canopen if it is there, which imports python-can, whose module
#            for MF4 needs the asammdf that is not imported yet. It takes this for "not installed" and remembers it.
# Hurts:     Anyone who installs canopen into an environment that reads MF4: "The asammdf package was not found", with
#            asammdf in use on the line above.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            python-can==4.6.1 asammdf==8.8.28 canmatrix==1.2 canopen==2.4.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
import subprocess
import sys

WRITE = "can.MF4Writer('bus.mf4').stop(); print('written')"
for order in ("import can, asammdf", "import asammdf, can"):
    run = subprocess.run([sys.executable, "-c", f"{order}; {WRITE}"], capture_output=True, text=True)
    print(f"{order}:", (run.stdout or run.stderr).strip().splitlines()[-1])
END

cat >expected <<'END'
import can, asammdf: written
import asammdf, can: written
END
diff expected seen || { echo "CHANGED: canopen-hides-asammdf" >&2; exit 1; }
echo "PASS: import asammdf, can cannot write MF4, import can, asammdf can"
