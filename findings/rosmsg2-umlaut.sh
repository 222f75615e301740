#!/bin/sh
# SPDX-License-Identifier: MIT
# A frame called "Küche" loses its last letter when JavaScript writes it for ROS 2.
#
# Version:   @foxglove/rosmsg2-serialization 3.1.0.
# Expected:  The length of a string in CDR counts bytes, and ü has two.
# Behaviour: The length is counted in characters. The end of the text is cut off by as many bytes as there are beyond
#            ASCII, without a terminating zero; "é" alone becomes a zero byte. The serializer for ROS 1 of the same
#            family is right.
# Hurts:     Anyone who names rooms, people or frames outside English.
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

const definition = parse("string frame_id\nuint8 after\n", { ros2: true });
for (const frame_id of ["kitchen", "Küche", "é"]) {
  const data = new MessageWriter(definition).writeMessage({ frame_id, after: 7 });
  console.log(frame_id, JSON.stringify(new MessageReader(definition).readMessage(data)));
}
END
node write.mjs >seen

cat >expected <<'END'
kitchen {"frame_id":"kitchen","after":7}
Küche {"frame_id":"Küch","after":7}
é {"frame_id":"\u0000","after":7}
END
diff expected seen || { echo "CHANGED: rosmsg2-umlaut" >&2; exit 1; }
echo "PASS: Küche is read back as Küch"
