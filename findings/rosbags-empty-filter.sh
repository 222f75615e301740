#!/bin/sh
# SPDX-License-Identifier: MIT
# A bag read with a filter that matches no topic gives all topics.
#
# Version:   rosbags 0.11.9.
# Expected:  messages(connections=[c for c in bag.connections if c.topic == "/sonar"]) yields nothing where there is
#            no /sonar.
# Behaviour: An empty list means no filter, in SQLite and in MCAP.
# Hurts:     Anyone who misspells a topic: the readings of some other sensor are evaluated under its name.
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
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

NAME = "std_msgs/msg/String"
store = get_typestore(Stores.ROS2_HUMBLE)
for storage in (StoragePlugin.SQLITE3, StoragePlugin.MCAP):
    path = Path(storage.name)
    with Writer(path, version=9, storage_plugin=storage) as bag:
        for topic in ("/laser", "/camera"):
            connection = bag.add_connection(topic, NAME, typestore=store)
            bag.write(connection, 1, store.serialize_cdr(store.types[NAME](data=topic), NAME))
    with AnyReader([path]) as bag:
        for topic in ("/laser", "/sonar"):
            wanted = [connection for connection in bag.connections if connection.topic == topic]
            print(storage.name, topic, [connection.topic for connection, _, _ in bag.messages(connections=wanted)])
END

cat >expected <<'END'
SQLITE3 /laser ['/laser']
SQLITE3 /sonar ['/laser', '/camera']
MCAP /laser ['/laser']
MCAP /sonar ['/laser', '/camera']
END
diff expected seen || { echo "CHANGED: rosbags-empty-filter" >&2; exit 1; }
echo "PASS: asking for /sonar, which is not there, gives /laser and /camera"
