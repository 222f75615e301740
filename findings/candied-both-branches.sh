#!/bin/sh
# SPDX-License-Identifier: MIT
# candied decodes all branches of a multiplexed message from one frame, and knows an extended message only by a number
# that no frame has.
#
# Version:   candied 2.2.0 (Node).
# Expected:  The selector decides which signals a frame contains, and an extended frame is found by its 29 bits.
# Behaviour: The multiplexer is parsed and not looked at when frames are decoded. Identifiers are compared with those
#            of the file, where bit 31 marks an extended one. A frame that is longer or shorter than declared is not
#            decoded either.
# Hurts:     Anyone who sends a ring of ranges in one multiplexed message, the usual way to have 16 of them: each frame
#            has news of all sensors, most of them from the bytes of others.
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

cat >branches.cjs <<'END'
const { Can, Dbc } = require("candied");

const dbc = new Dbc();
const data = dbc.load(`VERSION ""

NS_ :

BS_:

BU_: ECU

BO_ 256 Ring: 3 ECU
 SG_ Sector M : 0|8@1+ (1,0) [0|0] "" Vector__XXX
 SG_ Range0 m0 : 8|16@1+ (1,0) [0|0] "mm" Vector__XXX
 SG_ Range1 m1 : 8|16@1+ (1,0) [0|0] "mm" Vector__XXX
 SG_ Range2 m2 : 8|16@1+ (1,0) [0|0] "mm" Vector__XXX

BO_ 2566844926 Engine: 8 ECU
 SG_ Oil : 0|8@1+ (1,0) [0|0] "" Vector__XXX
`);
const can = new Can();
can.database = data;
for (const [sector, range] of [[0, 1000], [1, 2000], [2, 3000]]) {
  const seen = can.decode(can.createFrame(256, [sector, range & 255, range >> 8])).boundSignals;
  const values = [...seen].map(([name, one]) => `${name} ${one.value}`);
  console.log(`sector ${sector} at ${range}:`, values.join(", "));
}
const payload = [1, 2, 3, 4, 5, 6, 7, 8];
for (const id of [0x18fef1fe, 0x98fef1fe]) {
  const seen = can.decode(can.createFrame(id, payload, true));
  console.log(`extended frame ${id.toString(16)}:`, seen ? seen.name : seen);
}
END
node branches.cjs >seen

cat >expected <<'END'
sector 0 at 1000: Sector 0, Range0 1000, Range1 1000, Range2 1000
sector 1 at 2000: Sector 1, Range0 2000, Range1 2000, Range2 2000
sector 2 at 3000: Sector 2, Range0 3000, Range1 3000, Range2 3000
extended frame 18fef1fe: undefined
extended frame 98fef1fe: Engine
END
diff expected seen || { echo "CHANGED: candied-both-branches" >&2; exit 1; }
echo "PASS: each frame has the ranges of all sectors"
