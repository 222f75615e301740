#!/bin/sh
# SPDX-License-Identifier: MIT
# rosbag-merge -ib morning.bag merges all bags of the current folder too, and morning.bag twice: each of its messages
# is there two times.
#
# Version:   rosbag-merge 0.1.6, rosbags 0.9.16, numpy 1.26.4.
# Expected:  The bags that are named are merged.
# Behaviour: The folders to search have a default of ./, a text, of which each letter is taken as a folder: . is the
#            current one and / the root. All bags there are added to those named. A bag of the current folder has two
#            spellings and is read twice. With -ip and a folder without bags the named one alone is copied.
# Hurts:     Anyone who merges two of the bags of a folder, counts messages or computes a rate from the result.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            rosbag-merge==0.1.6 \
            rosbags==0.9.16 \
            icecream==2.2.0 \
            colorama==0.4.6 \
            Pygments==2.21.0 \
            executing==2.3.0 \
            asttokens==3.0.2 \
            tqdm==4.70.1 \
            numpy==1.26.4 \
            lz4==4.4.5 \
            zstandard==0.25.0 \
            ruamel.yaml==0.19.1 \
            typing_extensions==4.16.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >merge.py <<'END'
import contextlib
import io
import os
import pathlib
import shutil
import struct

from rosbag_merge import main
from rosbags import rosbag1


def bag(name, words):
    """Write a bag with one message for each word, one a second."""
    pathlib.Path(name).unlink(missing_ok=True)
    with rosbag1.Writer(name) as writer:
        connection = writer.add_connection("/words", "std_msgs/msg/String")
        for second, word in enumerate(words):
            writer.write(connection, (100 + second) * 10**9, struct.pack("<I", len(word)) + word.encode())


def merged(*options):
    """Return what the merged bag contains."""
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        main.main(main.parse_args([*options, "--output_path", "../out", "--outbag_name", "all"]))
    with rosbag1.Reader("../out/all.bag") as reader:
        return [raw[4:].decode() for _, _, raw in reader.messages()]


for folder in ("bags", "out", "empty"):
    shutil.rmtree(folder, ignore_errors=True)
    os.mkdir(folder)
os.chdir("bags")
bag("morning.bag", ["one", "two"])
bag("last-year.bag", ["old"])
print("-ib morning.bag:", sorted(merged("-ib", "morning.bag")))
print("-ib morning.bag -ip ../empty:", sorted(merged("-ib", "morning.bag", "-ip", "../empty")))
END
venv/bin/python merge.py >seen

cat >expected <<'END'
-ib morning.bag: ['old', 'one', 'one', 'two', 'two']
-ib morning.bag -ip ../empty: ['one', 'two']
END
diff expected seen || { echo "CHANGED: rosbag-merge-takes-the-whole-folder" >&2; exit 1; }
echo "PASS: each message of the named bag is there twice, beside those of a bag not named"
