#!/bin/sh
# SPDX-License-Identifier: MIT
# A covariance of 35 values is written by the JavaScript serializer of ROS 1 with NaN at its end, and one of 37
# without its last.
#
# Version:   @foxglove/rosmsg-serialization 2.0.4, @foxglove/rosmsg 5.0.5, rosbags 0.11.9 as the reader.
# Expected:  The writer refuses a fixed array with a wrong number of elements.
# Behaviour: What is missing is NaN, what is too much is dropped; a text such as "1.5" is taken for a number. Every
#            reader reads the result without complaint.
# Hurts:     Anyone who makes messages from JSON: a filter that gets the covariance turns its whole state to NaN.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            rosbags==0.11.9 || return 1
    npm install --silent --no-fund --no-audit @foxglove/rosmsg-serialization@2.0.4 @foxglove/rosmsg@5.0.5 tslib@2.9.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >write.js <<'END'
const { parse } = require("@foxglove/rosmsg");
const { MessageWriter } = require("@foxglove/rosmsg-serialization");
const writer = new MessageWriter(parse("float64[36] covariance\nfloat64 range"));
for (const count of [35, 36, 37]) {
  const message = { covariance: new Array(count).fill(1), range: "1.5" };
  console.log(Buffer.from(writer.writeMessage(message)).toString("hex"));
}
END
node write.js >written
venv/bin/python - >seen <<'END'
import numpy as np
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

store = get_typestore(Stores.EMPTY)
store.register(get_types_from_msg("float64[36] covariance\nfloat64 range\n", "x_msgs/msg/X"))
for line in open("written"):
    message = store.deserialize_ros1(bytes.fromhex(line.strip()), "x_msgs/msg/X")
    print(len(message.covariance), int(np.isnan(message.covariance).sum()), message.range)
END

cat >expected <<'END'
36 1 1.5
36 0 1.5
36 0 1.5
END
diff expected seen || { echo "CHANGED: rosmsg1-short-covariance" >&2; exit 1; }
echo "PASS: 35 values are written as 36 with NaN at the end"
