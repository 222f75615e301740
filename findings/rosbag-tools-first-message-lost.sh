#!/bin/sh
# SPDX-License-Identifier: MIT
# rosbag-tools clip from 0 s loses the first message of a bag whose time rounds up, and beyond its end writes an empty
# bag instead of the error it has for that.
#
# Version:   rosbag-tools 0.0.10 with its rosbags 0.9.16.
# Expected:  A clip from 0 s to the end is the whole bag, and one from 100 s of a bag of 2 s is refused, as the text of
#            the tool has it.
# Behaviour: Begin and end are added to the time stamp as floating-point numbers, which are 256 ns apart today: where
#            the sum is rounded up, the message at that very time is before it. The check wants a time that is below 0
#            and beyond the end at once, and so never fails. A ROS 1 bag cannot be clipped at all: AttributeError.
# Hurts:     Anyone who cuts bags that begin with a latched message, such as a map, or in a script.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            rosbag_tools==0.0.10 \
            rosbags==0.9.16 \
            numpy==1.26.4 \
            lz4==4.4.5 \
            zstandard==0.25.0 \
            ruamel.yaml==0.19.1 \
            PyYAML==6.0.4 \
            tqdm==4.70.1 \
            click==8.3.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >clip.py <<'END'
import contextlib
import io
import pathlib
import shutil
import struct
import sys
from unittest.mock import MagicMock

from rosbags import rosbag1, rosbag2

sys.modules["pandas"] = MagicMock()  # for another command

from rosbag_tools.clip.clipper import BagClipper


def bag(name, begin):
    """Write a ROS 2 bag of three messages, one a second, the first one at begin."""
    with rosbag2.Writer(pathlib.Path(name)) as writer:
        connection = writer.add_connection("/map", "std_msgs/msg/String")
        for number, text in enumerate((b"first", b"second", b"third")):
            writer.write(connection, begin + number * 10**9, b"\0\1\0\0" + struct.pack("<I", len(text) + 1) + text + b"\0")


def clip(name, start, end, out="out"):
    """Return the messages of a clip."""
    shutil.rmtree(out, ignore_errors=True)
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        BagClipper(name).clip_rosbag(start, end, out)
    with rosbag2.Reader(pathlib.Path(out)) as reader:
        return [bytes(data[8:-1]).decode() for _, _, data in reader.messages()]


for name, begin in (("even", 1_700_000_000 * 10**9), ("odd", 1_700_000_000 * 10**9 + 200)):
    shutil.rmtree(name, ignore_errors=True)
    bag(name, begin)
    print(f"begin {begin} ns, from 0.0 to 5.0 s: {clip(name, 0.0, 5.0)}")
print("from 100.0 to 200.0 s:", clip("even", 100.0, 200.0))
pathlib.Path("old.bag").unlink(missing_ok=True)
with rosbag1.Writer("old.bag") as writer:
    connection = writer.add_connection("/map", "std_msgs/msg/String")
    writer.write(connection, 1_700_000_000 * 10**9, struct.pack("<I", 5) + b"first")
try:
    clip("old.bag", 0.0, 1.0, "new.bag")
except AttributeError as error:
    print("ROS 1:", error)
END
venv/bin/python clip.py >seen

cat >expected <<'END'
begin 1700000000000000000 ns, from 0.0 to 5.0 s: ['first', 'second', 'third']
begin 1700000000000000200 ns, from 0.0 to 5.0 s: ['second', 'third']
from 100.0 to 200.0 s: []
ROS 1: 'Connection' object has no attribute 'md5sum'
END
diff expected seen || { echo "CHANGED: rosbag-tools-first-message-lost" >&2; exit 1; }
echo "PASS: the first message of a bag that begins at ...200 ns is lost"
