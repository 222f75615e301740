#!/bin/sh
# SPDX-License-Identifier: MIT
# Half a second before 1970 becomes one and a half in fromDate of @foxglove/rostime, and what subtract gives cannot be
# printed.
#
# Version:   @foxglove/rostime 1.1.3.
# Expected:  fromDate, fromMillis and subtract agree on -0.5 s, and toString prints it.
# Behaviour: fromDate gives sec -1 and nsec -500000000, which is -1.5 s. subtract gives sec -1 and nsec 500000000,
#            which toString refuses as negative.
# Hurts:     Anyone who prints how much earlier one message is than another, or starts a clock at zero and looks back.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    npm install --silent --no-fund --no-audit @foxglove/rostime@1.1.3 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >time.js <<'END'
const { fromDate, fromMillis, subtract, toSec, toString } = require("@foxglove/rostime");
console.log("fromDate", toSec(fromDate(new Date(-500))));
console.log("fromMillis", toSec(fromMillis(-500)));
const difference = subtract({ sec: 1, nsec: 0 }, { sec: 1, nsec: 500000000 });
console.log("subtract", toSec(difference));
try {
  console.log(toString(difference));
} catch (error) {
  console.log("toString refuses");
}
END
node time.js >seen

cat >expected <<'END'
fromDate -1.5
fromMillis -0.5
subtract -0.5
toString refuses
END
diff expected seen || { echo "CHANGED: rostime-before-zero" >&2; exit 1; }
echo "PASS: fromDate makes -1.5 s of 500 ms before 1970"
