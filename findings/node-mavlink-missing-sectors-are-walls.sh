#!/bin/sh
# SPDX-License-Identifier: MIT
# A ring of 16 sonars that node-mavlink sends has 56 obstacles at 0 cm: a short list is filled up with zeros, and NaN
# and a kind by its name become 0, too.
#
# Version:   node-mavlink 2.3.0, mavlink-mappings 1.0.21-20250824-1 (Node).
# Expected:  A list of 16 in a field of 72 is refused, or filled with 65535, which the message has for sectors that are
#            not used. NaN raises as Infinity does.
# Behaviour: Whatever is not there is 0, which is an obstacle at the hull. A new DISTANCE_SENSOR shows its kind and its
#            orientation by name; a name that is put there, as it stands there, is sent as 0, which is a laser that
#            looks ahead.
# Hurts:     Anyone who sends a ring with fewer than 72 sectors to an autopilot: it stops, or flies away from where
#            nothing is.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    npm install --silent --no-fund --no-audit --ignore-scripts \
        node-mavlink@2.3.0 \
        mavlink-mappings@1.0.21-20250824-1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >ring.cjs <<'END'
const { common } = require("mavlink-mappings");
const { MavLinkProtocolV2 } = require("node-mavlink");

const protocol = new MavLinkProtocolV2();

function sent(message) {
  const packet = protocol.serialize(message, 1);
  return protocol.data(packet.slice(10, 10 + packet[1]), message.constructor);
}

for (const ring of [Array(72).fill(150), Array(16).fill(150), [150, NaN, 12.7], [Infinity]]) {
  const message = new common.ObstacleDistance();
  message.distances = ring;
  const name = ring.length > 3 ? `${ring.length} ranges of 150` : ring.join(", ");
  try {
    const { distances } = sent(message);
    console.log(`${name}: begins`, distances.slice(0, 3), "has", distances.filter((one) => one === 0).length, "zeros");
  } catch (error) {
    console.log(`${name}: ${error.name}`);
  }
}
const sonar = new common.DistanceSensor();
console.log("a new DISTANCE_SENSOR:", sonar.type, sonar.orientation);
sonar.type = "ULTRASOUND";
sonar.orientation = "YAW_90";
console.log("set to ULTRASOUND and YAW_90:", common.MavDistanceSensor[sent(sonar).type], sent(sonar).orientation);
sonar.type = common.MavDistanceSensor.ULTRASOUND;
console.log("set to the number:", common.MavDistanceSensor[sent(sonar).type]);
END
node ring.cjs >seen

cat >expected <<'END'
72 ranges of 150: begins [ 150, 150, 150 ] has 0 zeros
16 ranges of 150: begins [ 150, 150, 150 ] has 56 zeros
150, NaN, 12.7: begins [ 150, 0, 12 ] has 70 zeros
Infinity: RangeError
a new DISTANCE_SENSOR: LASER NONE
set to ULTRASOUND and YAW_90: LASER 0
set to the number: ULTRASOUND
END
diff expected seen || { echo "CHANGED: node-mavlink-missing-sectors-are-walls" >&2; exit 1; }
echo "PASS: 16 ranges are sent with 56 zeros"
