#!/bin/sh
# SPDX-License-Identifier: MIT
# candied takes the start bit of a Motorola signal for its last bit: a range at the beginning of a frame is NaN, and
# others are read from bits of their neighbours.
#
# Version:   candied 2.2.0 (Node).
# Expected:  A DBC file gives the most significant bit of a signal in Motorola order, so 7|16@0 is the first two bytes.
# Behaviour: The bits are counted backwards from the start bit. What would begin before the frame is an empty text,
#            which is not a number; a later signal is made of the bits before it, without an error.
# Hurts:     Anyone who shows such a bus in a browser: one byte at 7|8 is NaN, and a second range has values that
#            change with the first.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    npm install --silent --no-fund --no-audit --ignore-scripts \
        candied@2.2.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >motorola.cjs <<'END'
const { Can, Dbc } = require("candied");

const dbc = new Dbc();
const data = dbc.load(`VERSION ""

NS_ :

BS_:

BU_: ECU

BO_ 256 Ring: 8 ECU
 SG_ First : 7|16@0+ (1,0) [0|0] "mm" Vector__XXX
 SG_ Second : 23|16@0+ (1,0) [0|0] "mm" Vector__XXX
 SG_ Third : 32|16@1+ (1,0) [0|0] "mm" Vector__XXX
 SG_ Fourth : 55|8@0+ (1,0) [0|0] "" Vector__XXX
`);
const can = new Can();
can.database = data;
for (const first of [1000, 1001, 2000]) {
  const payload = [first >> 8, first & 255, 2000 >> 8, 2000 & 255, 3000 & 255, 3000 >> 8, 7, 0];
  const seen = can.decode(can.createFrame(256, payload)).boundSignals;
  console.log(`${first}, 2000, 3000, 7 are read as`, [...seen.values()].map((one) => one.value).join(", "));
}
END
node motorola.cjs >seen

cat >expected <<'END'
1000, 2000, 3000, 7 are read as NaN, 2000, 3000, 22
1001, 2000, 3000, 7 are read as NaN, 2002, 3000, 22
2000, 2000, 3000, 7 are read as NaN, 4000, 3000, 22
END
diff expected seen || { echo "CHANGED: candied-motorola-is-nan" >&2; exit 1; }
echo "PASS: 1000 is NaN, and 2000 depends on it"
