#!/bin/sh
# SPDX-License-Identifier: MIT
# Of a ROS 1 bag that pybag wrote with a late message, the JavaScript reader loses what is older than the first one.
#
# Version:   pybag-sdk 0.13.0, @foxglove/rosbag 0.4.1, rosbags 0.11.9.
# Expected:  Five messages are written, the last ones with earlier times, and every reader gives five.
# Behaviour: pybag notes its first time of writing as the bag's start. @foxglove/rosbag begins there and gives three
#            of five; rosbags gives all, but its start_time is the wrong one, so a window from start_time on loses the
#            two as well.
# Hurts:     Anyone who writes bags of merged or late messages, and opens them in Foxglove.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            pybag-sdk==0.13.0 rosbags==0.11.9 || return 1
    npm install --silent --no-fund --no-audit @foxglove/rosbag@0.4.1 tslib@2.9.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
from pathlib import Path

from pybag.bag_writer import BagFileWriter
from pybag.ros1.noetic import std_msgs
from rosbags.highlevel import AnyReader

with BagFileWriter.open("late.bag") as bag:
    for number, t in enumerate((50, 60, 70, 30, 10)):
        bag.write_message("/range", t, std_msgs.Int32(data=number))
with AnyReader([Path("late.bag")]) as bag:
    print("rosbags", *(t for _, t, _ in bag.messages()))
    print("from its start", *(t for _, t, _ in bag.messages(start=bag.start_time)))
END
cat >read.js <<'END'
const { Bag } = require("@foxglove/rosbag");
const { FileReader } = require("@foxglove/rosbag/node");
(async () => {
  const bag = new Bag(new FileReader("late.bag"));
  await bag.open();
  const times = [];
  for await (const message of bag.messageIterator()) {
    times.push(message.timestamp.nsec);
  }
  console.log("foxglove", times.join(" "));
})();
END
node read.js >>seen

cat >expected <<'END'
rosbags 10 30 50 60 70
from its start 50 60 70
foxglove 50 60 70
END
diff expected seen || { echo "CHANGED: pybag-first-is-not-earliest" >&2; exit 1; }
echo "PASS: the two messages older than the first one are not read by @foxglove/rosbag"
