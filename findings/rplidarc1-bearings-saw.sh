#!/bin/sh
# SPDX-License-Identifier: MIT
# rplidarc1 reads bearings by a saw: they are up to a degree off, and go back at every third point.
#
# Version:   rplidarc1 0.1.3, rplidar-roboticia 0.9.5, pyserial 3.5.
# Expected:  The bearing of a point is the 15 bits above the check bit, in 64ths of a degree, as the protocol has it
#            and as rplidar-roboticia reads it.
# Behaviour: The low byte is not shifted: the check bit counts as 1/64 degree, each bit below counts twice, and the bit
#            of 1 degree is lost. Then the bearing is rounded to a third of a degree. Of a turn of 500 points 180 have
#            a smaller bearing than the point before.
# Hurts:     Anyone who maps with it or compares it with another sensor: edges are torn, and what relies on the order
#            of the points breaks.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            rplidarc1==0.1.3 \
            rplidar-roboticia==0.9.5 \
            pyserial==3.5 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >bearings.py <<'END'
import asyncio
import io

import rplidar
from rplidarc1.protocol import Response


class Port(io.BytesIO):
    """A serial port with the points of one turn."""

    @property
    def in_waiting(self):
        return 5 if self.tell() < len(self.getvalue()) else done.set() or 0


def point(bearing_deg):
    """Return a point of a normal scan at 2 m."""
    angle = round(bearing_deg * 64) << 1 | 1
    return bytes([15 << 2 | 2, angle & 0xFF, angle >> 8]) + (2000 * 4).to_bytes(2, "little")


async def read(points):
    """Return the bearings that rplidarc1 reads, and its dictionary of points."""
    queue, table = asyncio.Queue(), {}
    await queue.put(None)
    await Response.multi_response_handler(
        serial=Port(b"".join(points)), stop_event=done, output_queue=queue, length=5, output_dict=table
    )
    seen = []
    while not queue.empty():
        seen.append(queue.get_nowait())
    return [one["a_deg"] for one in seen[1:]], table


done = asyncio.Event()
true = [i * 0.72 for i in range(500)]
points = [point(bearing) for bearing in true]
other = [rplidar._process_scan(raw)[2] for raw in points]
bearings, table = asyncio.run(read(points))
print("true bearings:    ", [round(b, 2) for b in true[:8]])
print("rplidar-roboticia:", [round(b, 2) for b in other[:8]])
print("rplidarc1:        ", bearings[:8])
print(f"greatest errors: {max(abs(a - b) for a, b in zip(true, other)):.2f} and", end=" ")
print(f"{max(abs(a - b) for a, b in zip(true, bearings)):.2f} degrees")
print(f"of {len(points)} points {sum(b < a for a, b in zip(bearings, bearings[1:]))} step back")
END
venv/bin/python bearings.py >seen

cat >expected <<'END'
true bearings:     [0.0, 0.72, 1.44, 2.16, 2.88, 3.6, 4.32, 5.04]
rplidar-roboticia: [0.0, 0.72, 1.44, 2.16, 2.88, 3.59, 4.31, 5.05]
rplidarc1:         [0.0, 1.33, 1.0, 2.33, 3.67, 3.33, 4.67, 4.0]
greatest errors: 0.01 and 1.04 degrees
of 500 points 180 step back
END
diff expected seen || { echo "CHANGED: rplidarc1-bearings-saw" >&2; exit 1; }
echo "PASS: bearings are up to a degree off"
