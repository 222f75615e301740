#!/bin/sh
# SPDX-License-Identifier: MIT
# Three readers of ROS 2 disagree about the sign of both char and byte.
#
# Version:   rosbags 0.11.9, mcap-ros2-support 0.6.0, @foxglove/rosmsg2-serialization 3.1.0.
# Expected:  In ROS 2 both are one byte without a sign (uint8 and octet), so 200 is 200 everywhere.
# Behaviour: rosbags: char 200, byte -56. mcap-ros2-support: char -56, byte 200. The JavaScript reader: 200 both. The
#            writers are as strict: each of the two in Python raises for a value that the other needs.
# Hurts:     Anyone who passes states or levels in a byte (DiagnosticStatus.level is one) between tools.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            rosbags==0.11.9 mcap-ros2-support==0.6.0 || return 1
    npm install --silent --no-fund --no-audit --ignore-scripts \
        @foxglove/rosmsg@5.0.5 @foxglove/rosmsg2-serialization@3.1.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >read.py <<'END'
import json
from pathlib import Path
from mcap_ros2.reader import read_ros2_messages
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

NAME, TEXT = "own/msg/Small", "char c\nbyte b\n"
store = get_typestore(Stores.ROS2_HUMBLE)
store.register(get_types_from_msg(TEXT, NAME))
raw = bytes([0, 1, 0, 0, 200, 200])
message = store.deserialize_cdr(raw, NAME)
print("rosbags", message.c, message.b)
with Writer(Path("bag"), version=9, storage_plugin=StoragePlugin.MCAP) as bag:
    bag.write(bag.add_connection("/small", NAME, typestore=store), 1, raw)
for item in read_ros2_messages("bag/bag.mcap"):
    print("mcap-ros2-support", item.ros_msg.c, item.ros_msg.b)
END
cat >read.mjs <<'END'
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";

const reader = new MessageReader(parse("char c\nbyte b\n", { ros2: true }));
const { c, b } = reader.readMessage(new Uint8Array([0, 1, 0, 0, 200, 200]));
console.log("rosmsg2-serialization", c, b);
END
venv/bin/python -W ignore read.py >seen
node read.mjs >>seen

cat >expected <<'END'
rosbags 200 -56
mcap-ros2-support -56 200
rosmsg2-serialization 200 200
END
diff expected seen || { echo "CHANGED: ros2-char-and-byte" >&2; exit 1; }
echo "PASS: the byte 200 in char and byte is read as 200 -56, -56 200 and 200 200"
