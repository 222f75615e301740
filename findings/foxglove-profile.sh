#!/bin/sh
# SPDX-License-Identifier: MIT
# ROS 2 messages that foxglove-sdk records cannot be opened by rosbags, since one word of the header is empty.
#
# Version:   foxglove-sdk 0.30.3, rosbags 0.11.9, mcap-ros2-support 0.6.0.
# Expected:  Channels with the encoding cdr and a schema in ros2msg tell all that a reader of ROS 2 needs.
# Behaviour: rosbags asks for the profile "ros2" in the header, which is optional and which foxglove-sdk leaves empty.
#            mcap-ros2-support reads the file. With profile="ros2" among the options of the writer rosbags does, too.
# Hurts:     Anyone who records with the SDK and analyses offline: the whole file seems to be no ROS.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            rosbags==0.11.9 mcap-ros2-support==0.6.0 foxglove-sdk==0.30.3 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python -W ignore - >seen <<'END'
from pathlib import Path
import foxglove
from foxglove.mcap import MCAPWriteOptions
from mcap_ros2.reader import read_ros2_messages
from rosbags.highlevel import AnyReader, AnyReaderError

schema = foxglove.Schema(name="std_msgs/msg/UInt8", encoding="ros2msg", data=b"uint8 data")
for options in (MCAPWriteOptions(), MCAPWriteOptions(profile="ros2")):
    with foxglove.open_mcap("small.mcap", allow_overwrite=True, writer_options=options):
        channel = foxglove.Channel("/small", message_encoding="cdr", schema=schema)
        channel.log(bytes([0, 1, 0, 0, 7]), log_time=1)
        channel.close()
    print("mcap-ros2-support", *(item.ros_msg.data for item in read_ros2_messages("small.mcap")))
    try:
        with AnyReader([Path("small.mcap")]) as bag:
            print("rosbags", *(bag.deserialize(raw, connection.msgtype).data for connection, _, raw in bag.messages()))
    except AnyReaderError as error:
        print("rosbags", error)
END

cat >expected <<'END'
mcap-ros2-support 7
rosbags Profile is not ros2.
mcap-ros2-support 7
rosbags 7
END
diff expected seen || { echo "CHANGED: foxglove-profile" >&2; exit 1; }
echo "PASS: rosbags refuses the file, and reads it once the profile is ros2"
