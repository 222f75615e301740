#!/bin/sh
# SPDX-License-Identifier: MIT
# candied replaces a value outside the limits of a DBC file by the limit, and looks up the name of a state by the
# scaled value.
#
# Version:   candied 2.2.0 (Node).
# Expected:  The limits are information, and 65535 mm stays what it is. The table of a signal names raw values, as the
#            format defines.
# Behaviour: 65535, which marks a lost echo, is a wall at 5000 mm, the largest valid range. With a factor of 0.5 the
#            raw state 4 has the name of 2. Only limits of 0 and 0 are taken for none.
# Hurts:     Anyone who recognises lost echoes by their value, or reads faults by name: both are plausible and wrong.
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

cat >limits.cjs <<'END'
const { Can, Dbc } = require("candied");

const dbc = new Dbc();
const data = dbc.load(`VERSION ""

NS_ :

BS_:

BU_: ECU

BO_ 256 Ring: 4 ECU
 SG_ Range : 0|16@1+ (1,0) [150|5000] "mm" Vector__XXX
 SG_ State : 16|8@1+ (0.5,0) [0|0] "" Vector__XXX
 SG_ Speed : 24|8@1- (1,0) [0|100] "" Vector__XXX

VAL_ 256 State 4 "blind" 2 "weak" 0 "good" ;
`);
const can = new Can();
can.database = data;
for (const [range, state, speed] of [[1000, 0, 10], [65535, 4, -10], [0, 2, 120]]) {
  const frame = can.createFrame(256, [range & 255, range >> 8, state, speed & 255]);
  const seen = can.decode(frame).boundSignals;
  console.log(
    `range ${range}: ${seen.get("Range").value}, state ${state}: "${seen.get("State").physValue}",`,
    `speed ${speed}: ${seen.get("Speed").value}`,
  );
}
END
node limits.cjs >seen

cat >expected <<'END'
range 1000: 1000, state 0: "good", speed 10: 10
range 65535: 5000, state 4: "weak", speed -10: 0
range 0: 150, state 2: "1", speed 120: 100
END
diff expected seen || { echo "CHANGED: candied-cuts-to-the-limits" >&2; exit 1; }
echo "PASS: 65535 is 5000, and blind is weak"
