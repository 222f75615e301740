#!/bin/sh
# SPDX-License-Identifier: MIT
# A magnetic variation of 3.1 degrees east is -3.1 in extended-nmea and 3.1 in gps, both for Node, from one sentence.
#
# Version:   extended-nmea 2.1.3, gps 0.9.0.
# Expected:  Variations to the east are positive, as on charts: true heading is magnetic heading plus variation.
# Behaviour: extended-nmea has both signs the other way round: west is positive. A time with one decimal, which
#            receivers of 10 Hz send, raises an error in it when it is asked for; gps reads it.
# Hurts:     Anyone who corrects a compass by it: the error is doubled instead of removed.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    npm install --silent --no-fund --no-audit --ignore-scripts \
        extended-nmea@2.1.3 \
        gps@0.9.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >variation.cjs <<'END'
const { Decoder } = require("extended-nmea");
const { GPS } = require("gps");

const sentence = (text) =>
  `$${text}*${[...text].reduce((sum, letter) => sum ^ letter.charCodeAt(0), 0).toString(16).toUpperCase().padStart(2, "0")}`;

for (const [time, variation] of [["123519.00", "3.1,E"], ["123519.00", "3.1,W"], ["123519.5", "3.1,E"]]) {
  const line = sentence(`GPRMC,${time},A,4807.038,N,01131.000,E,2.0,84.4,281126,${variation},A`);
  const one = Decoder.decode(line);
  const other = GPS.Parse(line);
  let seconds;
  try {
    seconds = one.time.totalSeconds;
  } catch (error) {
    seconds = error.message;
  }
  console.log(`${time} ${variation}: extended-nmea ${one.magneticVariation}, ${seconds}; gps ${other.variation}, ${other.time.toISOString().slice(11)}`);
}
END
node variation.cjs >seen

cat >expected <<'END'
123519.00 3.1,E: extended-nmea -3.1, 45319; gps 3.1, 12:35:19.000Z
123519.00 3.1,W: extended-nmea 3.1, 45319; gps -3.1, 12:35:19.000Z
123519.5 3.1,E: extended-nmea -3.1, Expected data formatted as 'hhmmss.sss' or 'hhmmss', but found 8 characters; gps 3.1, 12:35:19.500Z
END
diff expected seen || { echo "CHANGED: extended-nmea-east-is-minus" >&2; exit 1; }
echo "PASS: 3.1 degrees east are -3.1 in one and 3.1 in the other"
