#!/bin/sh
# SPDX-License-Identifier: MIT
# sensor_lib writes the bytes of an Ouster packet one behind the other as decimal digits: a range of 1000 mm is 2323,
# and one of 256 mm is 1.
#
# Version:   sensor-library-justgo13 0.2.1, pandas 2.2.3, numpy 1.26.4.
# Expected:  A number of two or three bytes, the lowest first, is their sum with weights of 1, 256 and 65536.
# Behaviour: The bytes 232 and 3 are joined to the text 2323, with the last byte of the encoder before them, and that
#            is the range. A nearer wall may be farther. The encoder is joined in the other order, and goes from 255 to
#            10. The second azimuth block is read one byte later, not one block.
# Hurts:     Anyone who computes points of the recording: they are not noisy but elsewhere.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            sensor-library-justgo13==0.2.1 \
            pandas==2.2.3 \
            numpy==1.26.4 \
            python-dateutil==2.9.0.post0 \
            pytz==2025.2 \
            tzdata==2025.2 \
            six==1.17.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >ranges.py <<'END'
import contextlib
import io
import struct

import pandas
from sensor_lib import lidar_extract


def row(ranges, encoder, frame):
    """A packet of 16 blocks as numbers of bytes, after a column with its own number; all blocks have the ranges."""
    channels = b"".join(struct.pack("<I", millimetres) + bytes(8) for millimetres in ranges) + bytes(12 * (64 - len(ranges)))
    block = struct.pack("<QHHI", 0, 0, frame, encoder) + channels + b"\xff" * 4
    return [0, *(block * 16)]


def seen(call, *arguments, **choices):
    with contextlib.redirect_stdout(io.StringIO()):
        return call(*arguments, single_row=True, **choices)


ranges = [255, 256, 1000, 1024, 1279]
data = pandas.DataFrame([row(ranges, 255, 15), row(ranges, 256, 261)])
for millimetres, read in zip(ranges, seen(lidar_extract.get_range, data, 0)):
    print(f"range {millimetres} mm: {read}")
print("the same in the second block:", seen(lidar_extract.get_range, data, 0, azimuth_block=1)[2])
for number, encoder in enumerate((255, 256)):
    print(f"encoder {encoder}: {seen(lidar_extract.get_encoder_count, data, number)[0]}")
END
venv/bin/python ranges.py >seen

cat >expected <<'END'
range 255 mm: 2550
range 256 mm: 1
range 1000 mm: 2323
range 1024 mm: 4
range 1279 mm: 2554
the same in the second block: 23230
encoder 255: 255
encoder 256: 10
END
diff expected seen || { echo "CHANGED: sensor-lib-bytes-as-digits" >&2; exit 1; }
echo "PASS: 1000 mm are read as 2323, 256 mm as 1"
