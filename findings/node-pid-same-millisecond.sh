#!/bin/sh
# SPDX-License-Identifier: MIT
# Two updates of node-pid-controller within one millisecond count as one second: at 2 kHz the integral grows 501 times
# too fast.
#
# Version:   node-pid-controller 1.0.1.
# Expected:  The time between two updates is measured: an error of 1 integrates to 1 in a second, however often it is
#            updated.
# Behaviour: The clock has whole milliseconds, and a difference of 0 is replaced by 1 s, as is the first one. At 500 Hz
#            an error of 1 gives 2 after a second, of which 1 is the first update; at 2 kHz it gives 1002. The
#            derivative is a thousandth of what it should be in these steps.
# Hurts:     Anyone who updates in a fast loop, or twice by two events that come together.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    npm install --silent --no-fund --no-audit --ignore-scripts \
        node-pid-controller@1.0.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >integral.cjs <<'END'
const Controller = require("node-pid-controller");

let now = 0;
Date.now = () => Math.floor(now);
for (const hertz of [100, 500, 1000, 2000]) {
  const controller = new Controller({ k_p: 0, k_i: 1, k_d: 0 });
  controller.setTarget(1);
  let output;
  for (let step = 0; step <= hertz; step++) {
    now = 1e6 + (step * 1000) / hertz;
    output = controller.update(0);
  }
  console.log(`${hertz} Hz: an error of 1 for one second integrates to ${output.toFixed(2)}`);
}
END
node integral.cjs >seen

cat >expected <<'END'
100 Hz: an error of 1 for one second integrates to 2.00
500 Hz: an error of 1 for one second integrates to 2.00
1000 Hz: an error of 1 for one second integrates to 2.00
2000 Hz: an error of 1 for one second integrates to 1002.00
END
diff expected seen || { echo "CHANGED: node-pid-same-millisecond" >&2; exit 1; }
echo "PASS: at 2 kHz an error of 1 integrates to 1002 in a second"
