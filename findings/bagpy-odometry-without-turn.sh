#!/bin/sh
# SPDX-License-Identifier: MIT
# odometry_data of bagpy writes no turn rates: the columns angular.x, y and z have names and no values.
#
# Version:   bagpy 0.5, rosbags 0.11.9 as the writer, bitstring 5.0.0, pandas 3.1.1, numpy 2.4.6.
# Expected:  A message of odometry has a velocity and a turn rate, the header of the CSV file names both, and so both
#            are there.
# Behaviour: The rows have fourteen values where the header has seventeen names: the three of the turn rate are left
#            out, which pandas reads as NaN. vel_data of the same bag writes the same numbers of a Twist whole.
#            Covariances are in neither.
# Hurts:     Anyone who compares the odometry of a turning robot with a gyroscope. message_by_topic has all fields.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            bagpy==0.5 \
            rosbags==0.11.9 \
            bitstring==5.0.0 \
            pandas==3.1.1 \
            numpy==2.4.6 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >odometry.py <<'END'
import warnings
from pathlib import Path

import numpy as np
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_typestore

warnings.simplefilter("ignore")
store = get_typestore(Stores.ROS1_NOETIC)
types = store.types
Vector, Twist = types["geometry_msgs/msg/Vector3"], types["geometry_msgs/msg/Twist"]
twist = Twist(Vector(0.5, 0.0, 0.0), Vector(0.0, 0.0, 0.25))
place = types["geometry_msgs/msg/Pose"](types["geometry_msgs/msg/Point"](1.0, 2.0, 0.0), types["geometry_msgs/msg/Quaternion"](0.0, 0.0, 0.0, 1.0))
header = types["std_msgs/msg/Header"](0, types["builtin_interfaces/msg/Time"](1, 0), "odom")
pose = types["geometry_msgs/msg/PoseWithCovariance"](place, np.zeros(36))
odometry = types["nav_msgs/msg/Odometry"](header, "base", pose, types["geometry_msgs/msg/TwistWithCovariance"](twist, np.zeros(36)))
with Writer(Path("drive.bag")) as bag:
    for topic, kind, message in (("/odom", "nav_msgs/msg/Odometry", odometry), ("/cmd_vel", "geometry_msgs/msg/Twist", twist)):
        bag.write(bag.add_connection(topic, kind, typestore=store), 10**9, store.serialize_ros1(message, kind))

import pandas
from bagpy import bagreader

reader = bagreader("drive.bag", verbose=False)
for name, files in (("odometry_data", reader.odometry_data()), ("vel_data", reader.vel_data())):
    head, row = Path(files[0]).read_text().splitlines()
    table = pandas.read_csv(files[0])
    print(f"{name}: {len(head.split(','))} names, {len(row.split(','))} values, linear.x {table['linear.x'][0]}, angular.z {table['angular.z'][0]}")
whole = pandas.read_csv(reader.message_by_topic("/odom"))
print("message_by_topic: angular.z", whole["twist.twist.angular.z"][0])
END
venv/bin/python odometry.py >seen 2>errors || { cat errors >&2; exit 1; }

cat >expected <<'END'
odometry_data: 17 names, 14 values, linear.x 0.5, angular.z nan
vel_data: 7 names, 7 values, linear.x 0.5, angular.z 0.25
message_by_topic: angular.z 0.25
END
diff expected seen || { echo "CHANGED: bagpy-odometry-without-turn" >&2; exit 1; }
echo "PASS: the turn rate of odometry is NaN"
