#!/bin/sh
# SPDX-License-Identifier: MIT
# Of a topic with two publishers importRosbag reads the messages of one, without a word: half of the poses are
# missing.
#
# Version:   importRosbag 1.0.4, rosbags 0.11.9 as the writer, tqdm 4.70.1, numpy 2.4.6.
# Expected:  All messages of a topic are imported, in the order of their times: two nodes may publish to one topic, as
#            they do with /tf.
# Behaviour: A bag of ROS 1 has a connection for each publisher. The connections are sorted into a dictionary by topic,
#            and the last one replaces the others. Types that it does not know, LaserScan and Range among them, are
#            left out with a line in the log; Odometry is left out too, though there is a reader for it.
# Hurts:     Anyone who counts messages or computes rates, or needs the transforms of a second node.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            importRosbag==1.0.4 \
            rosbags==0.11.9 \
            tqdm==4.70.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >publishers.py <<'END'
from pathlib import Path

from importRosbag.importRosbag import importRosbag
from rosbags.rosbag1 import Reader, Writer
from rosbags.typesys import Stores, get_typestore

store = get_typestore(Stores.ROS1_NOETIC)
Header, Time = store.types["std_msgs/msg/Header"], store.types["builtin_interfaces/msg/Time"]
Stamped, Pose, Point, Quaternion = (store.types[f"geometry_msgs/msg/{name}"] for name in ("PoseStamped", "Pose", "Point", "Quaternion"))
KIND = "geometry_msgs/msg/PoseStamped"
with Writer(Path("two.bag")) as bag:
    nodes = [bag.add_connection("/pose", KIND, typestore=store, callerid=node) for node in ("/front", "/rear")]
    for second in range(10):
        place = Pose(Point(float(second), 0.0, 0.0), Quaternion(0.0, 0.0, 0.0, 1.0))
        message = Stamped(Header(second, Time(second, 0), "odom"), place)
        bag.write(nodes[second % 2], second * 10**9, store.serialize_ros1(message, KIND))
with Reader(Path("two.bag")) as bag:
    print("rosbags:", [store.deserialize_ros1(data, KIND).pose.position.x for _, _, data in bag.messages()])
print("importRosbag:", importRosbag("two.bag", disable_bar=True)["/pose"]["point"][:, 0].tolist())
END
venv/bin/python publishers.py >seen

cat >expected <<'END'
rosbags: [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]
importRosbag: [1.0, 3.0, 5.0, 7.0, 9.0]
END
diff expected seen || { echo "CHANGED: importrosbag-one-publisher" >&2; exit 1; }
echo "PASS: of two publishers one is read"
