#!/bin/sh
# SPDX-License-Identifier: MIT
# A misspelt field is dropped by mcap-ros2-support and the true one is written as zero; a list that is too long is
# cut.
#
# Version:   mcap-ros2-support 0.6.0.
# Expected:  A dictionary with a key that the type lacks, or three items for two places, is refused.
# Behaviour: Nothing is raised: "ranges" vanishes and range is 0.0, the third item of float32[2] vanishes, a missing
#            second is 0. A value too large for its type does raise.
# Hurts:     Anyone who makes ranges for a test or a replay: 0 m is a valid reading, an obstacle that touches.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            mcap-ros2-support==0.6.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

venv/bin/python - >seen <<'END'
import io
from mcap_ros2.reader import read_ros2_messages
from mcap_ros2.writer import Writer

for message in (
    {"range": 2.5, "limits": [0.25, 5.0]},
    {"ranges": 2.5, "limits": [0.25, 5.0, 7.0]},
    {"range": 2.5, "limits": [0.25]},
    {"range": 2.5, "limits": [0.25, 5.0], "kind": 256},
):
    file = io.BytesIO()
    writer = Writer(file)
    schema = writer.register_msgdef("own/msg/Range", "float32 range\nfloat32[2] limits\nuint8 kind\n")
    try:
        writer.write_message("/range", schema, message, log_time=1)
        writer.finish()
        file.seek(0)
        print(*(item.ros_msg for item in read_ros2_messages(file)))
    except Exception as error:
        print(type(error).__name__)
END

cat >expected <<'END'
Range(range=2.5, limits=[0.25, 5.0], kind=0)
Range(range=0.0, limits=[0.25, 5.0], kind=0)
Range(range=2.5, limits=[0.25, 0.0], kind=0)
error
END
diff expected seen || { echo "CHANGED: mcap-ros2-typo" >&2; exit 1; }
echo "PASS: the range under the key ranges is written as 0.0"
