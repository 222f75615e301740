#!/bin/sh
# SPDX-License-Identifier: MIT
# Of a bag that was split into two files ros2bag-reader gives the messages of another topic from the second file on.
#
# Version:   ros2bag-reader 0.1.0, PyYAML 6.0.4, numpy 2.4.6.
# Expected:  Each file of a bag has its own table of topics, and a topic is looked up in the table of the file.
# Behaviour: The numbers of the topics are taken from the first file alone and used for all. A recorder that splits a
#            bag numbers the topics anew, in any order: the messages of /odom are read as scans then. Messages come in
#            the order in which they were stored, not by time.
# Hurts:     Anyone who reads long recordings, which are split by size: bytes of one type are decoded as another.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            ros2bag-reader==0.1.0 \
            PyYAML==6.0.4 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >split.py <<'END'
import sqlite3
import sys
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import MagicMock

import yaml

for module in ("rosidl_runtime_py", "rosidl_runtime_py.utilities", "rclpy", "rclpy.serialization"):
    sys.modules[module] = MagicMock()  # of ROS: here a message is its bytes and the type that it is decoded as
sys.modules["rosidl_runtime_py.utilities"].get_message = lambda name: name
sys.modules["rclpy.serialization"].deserialize_message = lambda data, kind: f"{data.decode()} decoded as {kind}"

from ros2bag_reader.ros2bag_reader import ROS2BagReader

TYPES = {"/scan": "sensor_msgs/msg/LaserScan", "/odom": "nav_msgs/msg/Odometry"}
bag = Path("bag")
bag.mkdir(exist_ok=True)
for number, order in enumerate((("/scan", "/odom"), ("/odom", "/scan"))):
    (bag / f"bag_{number}.db3").unlink(missing_ok=True)
    with sqlite3.connect(bag / f"bag_{number}.db3") as base:
        base.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
        base.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
        for topic, name in enumerate(order, 1):
            base.execute("INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')", (topic, name, TYPES[name]))
            base.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", (topic, number * 10**9, f"{name[1:]} of second {number}".encode()))
info = {"files": [{"path": f"bag_{number}.db3"} for number in (0, 1)]}
(bag / "metadata.yaml").write_text(yaml.safe_dump({"rosbag2_bagfile_information": info}))
for time, message in ROS2BagReader("bag").get_messages("/scan"):
    print(f"/scan at {time // 10**9} s: {message}")
END
venv/bin/python split.py >seen

cat >expected <<'END'
/scan at 0 s: scan of second 0 decoded as sensor_msgs/msg/LaserScan
/scan at 1 s: odom of second 1 decoded as sensor_msgs/msg/LaserScan
END
diff expected seen || { echo "CHANGED: ros2bag-reader-split-bag" >&2; exit 1; }
echo "PASS: in the second file /scan is /odom"
