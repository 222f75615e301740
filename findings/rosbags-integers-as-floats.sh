#!/bin/sh
# SPDX-License-Identifier: MIT
# Ranges given to rosbags as whole millimetres of 32 bits are stored as 1.4e-42 m, not as 1000.
#
# Version:   rosbags 0.11.9.
# Expected:  An array of another type than the message has is converted, or refused as float64 is.
# Behaviour: Any array whose items have 4 bytes is taken byte for byte: int32 becomes denormal floats, big-endian
#            floats become noise. float64 raises, so the type seems to be checked.
# Hurts:     Anyone who makes LaserScan of a device that counts in millimetres: the scan is valid and shows an
#            obstacle at 0.
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
import numpy as np
from rosbags.typesys import Stores, get_typestore

NAME = "sensor_msgs/msg/LaserScan"
store = get_typestore(Stores.ROS2_HUMBLE)
kinds = store.types
stamp = kinds["builtin_interfaces/msg/Time"](sec=0, nanosec=0)
header = kinds["std_msgs/msg/Header"](stamp=stamp, frame_id="laser")
for dtype in ("<f4", "<i4", ">f4", "<f8"):
    scan = kinds[NAME](header, 0.0, 1.0, 0.5, 0.0, 0.0, 0.0, 5.0, np.array([1000, 2000], dtype), np.array([], "<f4"))
    try:
        print(dtype, store.deserialize_cdr(store.serialize_cdr(scan, NAME), NAME).ranges)
    except ValueError as error:
        print(dtype, type(error).__name__)
END

cat >expected <<'END'
<f4 [1000. 2000.]
<i4 [1.401e-42 2.803e-42]
>f4 [4.3861e-41 8.9778e-41]
<f8 ValueError
END
diff expected seen || { echo "CHANGED: rosbags-integers-as-floats" >&2; exit 1; }
echo "PASS: int32 1000 and 2000 come back as 1.4e-42 and 2.8e-42"
