#!/bin/sh
# SPDX-License-Identifier: MIT
# The magnetic variation of RMC is the height of ggencoder, a receiver without a fix is valid at 0 0, and 10 knots
# that are passed on are 5.1.
#
# Version:   ggencoder 1.0.10 (Node).
# Expected:  RMC has no height. A GGA of quality 0 is not valid. What is decoded and encoded again keeps its speed.
# Behaviour: The field behind the date is taken for the height. Empty coordinates are 0, and the quality is overwritten
#           with true. Decoded speeds are in m/s, cut to a tenth, encoded ones are written as they are where knots
#           belong. Fractions of a second are dropped. 47.99999999 degrees are written as 47 degrees and 60 minutes.
#           Sentences of GN and other talkers are not valid.
# Hurts:     Anyone who relays positions of a robot or a boat by it: half of the speed, and a place in the Gulf of
#           Guinea until there is a fix.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    npm install --silent --no-fund --no-audit --ignore-scripts \
        ggencoder@1.0.10 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >relay.cjs <<'END'
const { NmeaDecode, NmeaEncode } = require("ggencoder");

const sentence = (body) => {
  const sum = [...body].reduce((xor, letter) => xor ^ letter.charCodeAt(0), 0);
  return `$${body}*${sum.toString(16).toUpperCase().padStart(2, "0")}`;
};
for (const body of [
  "GPRMC,120000.75,A,4807.038,N,01131.000,E,010.0,084.4,311224,003.1,W",
  "GPGGA,120000.75,,,,,0,00,,,M,,M,,",
  "GNRMC,120000.75,A,4807.038,N,01131.000,E,010.0,084.4,311224,003.1,W",
]) {
  const { valid, lat, lon, sog, alt, date } = new NmeaDecode(sentence(body));
  const time = body.includes("RMC") && valid ? new Date(date).toISOString() : "";
  console.log(`${body}:\n  valid ${valid}, ${lat?.toFixed(4)} ${lon?.toFixed(4)}, speed ${sog}, height ${alt} ${time}`);
}
const decoded = new NmeaDecode(sentence("GPRMC,120000.00,A,4807.038,N,01131.000,E,010.0,084.4,311224,,"));
const speed = ({ nmea }) => nmea.split(",")[7];
console.log("10.0 knots, passed on:", speed(new NmeaEncode(decoded)), speed(new NmeaEncode({ ...decoded, msgtype: 2 })));
console.log("47.99999999 degrees:", new NmeaEncode({ msgtype: 2, lat: 47.99999999, lon: 0, sog: 0, cog: 0 }).nmea.split(",")[3]);
END
node relay.cjs >seen

cat >expected <<'END'
GPRMC,120000.75,A,4807.038,N,01131.000,E,010.0,084.4,311224,003.1,W:
  valid true, 48.1173 11.5167, speed 5.1, height 3.1 2024-12-31T12:00:00.000Z
GPGGA,120000.75,,,,,0,00,,,M,,M,,:
  valid true, 0.0000 0.0000, speed NaN, height 0 
GNRMC,120000.75,A,4807.038,N,01131.000,E,010.0,084.4,311224,003.1,W:
  valid false, undefined undefined, speed undefined, height undefined 
10.0 knots, passed on: 5.1 5.1
47.99999999 degrees: 4760.0000
END
diff expected seen || { echo "CHANGED: ggencoder-variation-is-height" >&2; exit 1; }
echo "PASS: a variation of 3.1 degrees is a height of 3.1"
