#!/bin/sh
# SPDX-License-Identifier: MIT
# Messages of equal time come out of a ROS 1 bag grouped by topic, and out of a ROS 2 bag in the order written.
#
# Version:   rosbags 0.11.9.
# Expected:  A, B, A with one time stamp are read as A, B, A.
# Behaviour: rosbags sorts a ROS 1 bag by time and then by connection: A, A, B. The same written to ROS 2 keeps its
#            order.
# Hurts:     Anyone who replays a bag whose clock is coarse (simulated time): a command and the answers to it change
#            places.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            rosbags==0.11.9 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
from pathlib import Path
from rosbags.highlevel import AnyReader
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_typestore

NAME = "std_msgs/msg/String"
for path, make, stores in (
    (Path("one.bag"), Writer1, Stores.ROS1_NOETIC),
    (Path("two"), lambda path: Writer2(path, version=9), Stores.ROS2_HUMBLE),
):
    store = get_typestore(stores)
    serialize = store.serialize_ros1 if path.suffix else store.serialize_cdr
    with make(path) as bag:
        topics = {topic: bag.add_connection(topic, NAME, typestore=store) for topic in ("/a", "/b")}
        for text, topic in enumerate(("/a", "/b", "/a", "/b")):
            bag.write(topics[topic], 1_000_000_000, serialize(store.types[NAME](data=str(text)), NAME))
    with AnyReader([path]) as bag:
        print(path, *(bag.deserialize(raw, NAME).data for _, _, raw in bag.messages()))
END

cat >expected <<'END'
one.bag 0 2 1 3
two 0 1 2 3
END
diff expected seen || { echo "CHANGED: rosbags-ros1-equal-times" >&2; exit 1; }
echo "PASS: 0 1 2 3 comes out of a ROS 1 bag as 0 2 1 3"
