#!/bin/sh
# SPDX-License-Identifier: MIT
# rosbags-convert makes ROS 2 bags with topic names that ROS 2 does not allow.
#
# Version:   rosbags 0.11.9.
# Expected:  Names such as "/1-2" or "/front sonar" are renamed or refused, since ROS 2 allows neither a digit first,
#            nor "-", nor spaces.
# Behaviour: The names of ROS 1 are kept, also one without a slash before it. The converter ends with 0 and prints
#            nothing.
# Hurts:     Anyone who plays converted bags: the player cannot publish these topics.
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

venv/bin/python - <<'END'
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_typestore

store = get_typestore(Stores.ROS1_NOETIC)
kind = "std_msgs/msg/String"
with Writer("one.bag") as bag:
    for t, topic in enumerate(("/1-2", "chatter", "/front-sonar")):
        connection = bag.add_connection(topic, kind, typestore=store)
        bag.write(connection, t, store.serialize_ros1(store.types[kind](data="x"), kind))
END
venv/bin/rosbags-convert --src one.bag --dst two >seen 2>&1 || echo refused >>seen
venv/bin/python - >>seen <<'END'
import re
from pathlib import Path

from rosbags.highlevel import AnyReader

ALLOWED = re.compile(r"(/[A-Za-z_][A-Za-z0-9_]*)+")
with AnyReader([Path("two")]) as bag:
    for connection in bag.connections:
        print(connection.topic, "allowed" if ALLOWED.fullmatch(connection.topic) else "not allowed")
END

cat >expected <<'END'
/1-2 not allowed
chatter not allowed
/front-sonar not allowed
END
diff expected seen || { echo "CHANGED: rosbags-convert-topic-names" >&2; exit 1; }
echo "PASS: names that ROS 2 does not allow are kept without a word"
