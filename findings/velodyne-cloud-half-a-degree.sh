#!/bin/sh
# SPDX-License-Identifier: MIT
# Two decoders of one packet of a Velodyne differ by up to 0.65 degrees: @foxglove/velodyne-cloud puts all 32 points
# of a block at its first bearing.
#
# Version:   @foxglove/velodyne-cloud 1.0.1, velodyne-decoder 3.1.0, numpy 2.4.6.
# Expected:  The bearing of a point is that of the moment of its firing, between that of its block and of the next one.
#            Both decoders have it.
# Behaviour: The JavaScript works the bearing out, uses it to decide whether a point is in the range of angles that was
#            asked for, and then computes its place with that of the block. At 20 turns a second a block of a VLP-16
#            covers 0.8 degrees: the last point is 57 cm off at 50 m. Walls have steps.
# Hurts:     Anyone who compares a scan in Foxglove with the one that a robot worked with, or computes from it in Node.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            --no-deps \
            velodyne-decoder==3.1.0 \
            numpy==2.4.6 \
            PyYAML==6.0.4 \
            dpkt==1.9.8 \
            importlib_resources==7.1.0 &&
    npm install --silent --no-fund --no-audit --ignore-scripts \
        @foxglove/velodyne-cloud@1.0.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >place.cjs <<'END'
const { writeFileSync } = require("fs");
const { Calibration, Model, PointCloud, RawPacket, Transformer } = require("@foxglove/velodyne-cloud");

const packet = Buffer.alloc(1206); // of a VLP-16 at 20 Hz: 12 blocks of 0.8 degrees, all points at 50 m
for (let block = 0; block < 12; block++) {
  packet.writeUInt16LE(0xeeff, block * 100);
  packet.writeUInt16LE(9000 + block * 80, block * 100 + 2);
  for (let point = 0; point < 32; point++) {
    packet.writeUInt16LE(25000, block * 100 + 4 + 3 * point);
    packet[block * 100 + 6 + 3 * point] = 50;
  }
}
packet[1204] = 0x37; // strongest return
packet[1205] = 0x22; // VLP-16
writeFileSync("packet", packet);
const cloud = new PointCloud({ stamp: 0, maxPoints: 384 });
new Transformer(new Calibration(Model.VLP16)).unpack(new RawPacket(packet), 0, 0, cloud);
cloud.trim();
const bearings = [0, 15, 16, 31, 32].map((point) => {
  const { x, y } = cloud.point(point);
  return ((Math.atan2(-y, x) * 180) / Math.PI).toFixed(2);
});
console.log("@foxglove/velodyne-cloud, points 0, 15, 16, 31 and 32:", bearings.join(" "));
END

cat >place.py <<'END'
from math import atan2, degrees
from pathlib import Path

import velodyne_decoder as velodyne

decoder = velodyne.ScanDecoder(velodyne.Config(model=velodyne.Model.VLP16))
_, points = decoder.decode([velodyne.VelodynePacket(0.0, Path("packet").read_bytes())])
print("velodyne-decoder, points 0, 15, 16, 31 and 32:", *(f"{degrees(atan2(-float(points[i][1]), float(points[i][0]))):.2f}" for i in (0, 15, 16, 31, 32)))
END
node place.cjs >seen.js
venv/bin/python place.py >seen.py
cat seen.js seen.py >seen

cat >expected <<'END'
@foxglove/velodyne-cloud, points 0, 15, 16, 31 and 32: 90.00 90.00 90.00 90.00 90.80
velodyne-decoder, points 0, 15, 16, 31 and 32: 90.00 90.25 90.40 90.65 90.80
END
diff expected seen || { echo "CHANGED: velodyne-cloud-half-a-degree" >&2; exit 1; }
echo "PASS: the last point of a block is 0.65 degrees off"
