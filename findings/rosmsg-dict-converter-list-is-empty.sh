#!/bin/sh
# SPDX-License-Identifier: MIT
# rosmsg_dict_converter makes an empty list of the ranges of a ROS 1 scan, and with include_defaults a single 0; read
# from a bag the same scan keeps them.
#
# Version:   rosmsg-dict-converter 0.1.2, rosbag-standalone 1.17.4.1, pydantic 2.14.4.
# Expected:  A dictionary of a scan has the ranges of the scan.
# Behaviour: A list that is not one of messages is not looked at: its place is taken by nothing or by a default,
#            however full it is. A message that was unpacked has tuples, which are taken over. The way back puts
#            dictionaries into a list of poses, which cannot be sent.
# Hurts:     Anyone who makes scans in a program or a test and sends them as JSON: they are empty, where those of the
#            robot were right.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            rosmsg-dict-converter==0.1.2 \
            rosbag-standalone==1.17.4.1 \
            PyYAML==6.0.4 \
            lz4==4.4.5 \
            pydantic==2.14.4 \
            pydantic_core==2.50.5 \
            annotated-types==0.8.0 \
            typing_extensions==4.16.0 \
            typing-inspection==0.4.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >scan.py <<'END'
import io

from genpy.dynamic import generate_dynamic
from rosmsg_dict_converter.converter import a_dict_to_ros_message, ros_message_to_dict

SCAN = "float32 angle_min\nfloat32 angle_increment\nfloat32[] ranges\n"
Scan = generate_dynamic("test_msgs/Scan", SCAN)["test_msgs/Scan"]
made = Scan(angle_min=0.0, angle_increment=0.5, ranges=[1.0, 2.0, 4.0])
buffer = io.BytesIO()
made.serialize(buffer)
read = Scan().deserialize(buffer.getvalue())

print("made:", ros_message_to_dict(made)["ranges"])
print("made, include_defaults:", ros_message_to_dict(made, include_defaults=True)["ranges"])
print("unpacked:", ros_message_to_dict(read)["ranges"])

Path = generate_dynamic("test_msgs/Path", f"Point[] points\n{'=' * 80}\nMSG: test_msgs/Point\nfloat64 x\nfloat64 y\n")["test_msgs/Path"]
path = a_dict_to_ros_message(Path(), {"points": [{"x": 1.0, "y": 2.0}]})
print("a path from a dictionary has points of type", type(path.points[0]).__name__)
END
venv/bin/python scan.py >seen

cat >expected <<'END'
made: []
made, include_defaults: [0]
unpacked: (1.0, 2.0, 4.0)
a path from a dictionary has points of type dict
END
diff expected seen || { echo "CHANGED: rosmsg-dict-converter-list-is-empty" >&2; exit 1; }
echo "PASS: a scan of 1, 2 and 4 m has no ranges"
