#!/bin/sh
# SPDX-License-Identifier: MIT
# A loop over range(0, 4500, 10) never runs on a Thymio that was programmed by tdmclient, and one over range(0, 5)
# leaves its variable at 5.
#
# Version:   tdmclient 0.1.21.
# Expected:  A loop in Python goes through the same values on the robot as long as they fit into 16 bits.
# Behaviour: A loop with a step compares the variable times the step with the end times the step. Both are 16 bits, so
#            from an end of 3277 by 10 on the products wrap. A loop adds the step once more at its end, too, so that
#            the variable is beyond the range.
# Hurts:     Anyone who counts through proximities, which go to 4500, or uses the variable after the loop.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            tdmclient==0.1.21 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >loop.py <<'END'
import re

from tdmclient.atranspiler import ATranspiler


class Word(int):
    """A number of 16 bits with a sign, as the variables of a Thymio are."""

    def __new__(cls, value):
        return super().__new__(cls, (int(value) + 32768) % 65536 - 32768)

    def __mul__(self, other):
        return Word(int(self) * int(other))

    def __add__(self, other):
        return Word(int(self) + int(other))

    def __neg__(self):
        return Word(-int(self))


def run(program):
    """Run a program of Aseba, as far as it has assignments, sums and loops, and return its variables."""
    lines = []
    for line in program.splitlines():
        depth = len(line) - len(line.lstrip("\t"))
        text = line.strip()
        if not text or text.startswith("var ") or text == "end":
            continue
        text = re.sub(r"(\w+)\+\+", r"\1 += 1", text)
        text = re.sub(r"^while (.*) do$", r"while \1:", text)
        text = re.sub(r"(?<![\w\[])(\d+)", r"Word(\1)", text)
        lines.append("    " * depth + text)
    names = {"Word": Word, "_tmp": [Word(0)] * 4}
    exec("\n".join(lines), names)
    return names


for loop in ("range(0, 5)", "range(0, 3270, 10)", "range(0, 4500, 10)", "range(4500, 0, -10)", "range(0, 4500)"):
    source = f"n = 0\nlast = 0\nfor i in {loop}:\n    n += 1\n    last = i\n"
    robot = run(ATranspiler.simple_transpile(source))
    python = {}
    exec(source, python)
    print(f"{loop}: Python {python['n']} times, i {python['i']}; Thymio {robot['n']} times, i {robot['i']}")
END
venv/bin/python loop.py >seen

cat >expected <<'END'
range(0, 5): Python 5 times, i 4; Thymio 5 times, i 5
range(0, 3270, 10): Python 327 times, i 3260; Thymio 327 times, i 3270
range(0, 4500, 10): Python 450 times, i 4490; Thymio 0 times, i 0
range(4500, 0, -10): Python 450 times, i 10; Thymio 0 times, i 4500
range(0, 4500): Python 4500 times, i 4499; Thymio 4500 times, i 4500
END
diff expected seen || { echo "CHANGED: tdmclient-range-never-runs" >&2; exit 1; }
echo "PASS: range(0, 4500, 10) is gone through 0 times"
