#!/bin/sh
# SPDX-License-Identifier: MIT
# The JavaScript serializer of ROS 2 writes a bool of 1 as false, and a uint8 of 300 as 44.
#
# Version:   @foxglove/rosmsg2-serialization 3.1.0.
# Expected:  1 is true, as in every other language of ROS, or an error.
# Behaviour: Only the value true itself is written as true. Numbers are cut to their width. A fixed array of another
#            length is refused, so some checks are there.
# Hurts:     Anyone who passes on flags that came as numbers, from a database or from JSON of a device: all are off.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    npm install --silent --no-fund --no-audit --ignore-scripts \
        @foxglove/rosmsg@5.0.5 @foxglove/rosmsg2-serialization@3.1.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >write.mjs <<'END'
import { parse } from "@foxglove/rosmsg";
import { MessageReader, MessageWriter } from "@foxglove/rosmsg2-serialization";

const definition = parse("bool enabled\nuint8 count\n", { ros2: true });
for (const enabled of [true, 1, "true"]) {
  const data = new MessageWriter(definition).writeMessage({ enabled, count: 300 });
  console.log(JSON.stringify(enabled), JSON.stringify(new MessageReader(definition).readMessage(data)));
}
END
node write.mjs >seen

cat >expected <<'END'
true {"enabled":true,"count":44}
1 {"enabled":false,"count":44}
"true" {"enabled":false,"count":44}
END
diff expected seen || { echo "CHANGED: rosmsg2-bool-one" >&2; exit 1; }
echo "PASS: enabled 1 is read back as false"
