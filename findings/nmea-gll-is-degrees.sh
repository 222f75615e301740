#!/bin/sh
# SPDX-License-Identifier: MIT
# A position at 48.12 degrees north is written as 48.12 minutes by nmea for Node, whose GLL and GGA have degrees where
# NMEA has degrees and minutes.
#
# Version:   nmea 0.1.2, nmea-simple 3.3.0 as the reader.
# Expected:  48.1173 degrees are written as 4807.038: two digits of degrees, then minutes. The package has a function
#            that does it.
# Behaviour: Both are encoded with the function for headings: two digits after the point and zeros in front, 048.12.
#            The checksum is right and the sentences are valid. A reader finds the robot near the equator.
# Hurts:     Anyone who feeds a plotter, a logger or a simulated receiver by it.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    npm install --silent --no-fund --no-audit --ignore-scripts \
        nmea@0.1.2 \
        nmea-simple@3.3.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >gll.cjs <<'END'
const nmea = require("nmea");
const { parseNmeaSentence } = require("nmea-simple");

const place = { lat: 48.1173, latPole: "N", lon: 11.5167, lonPole: "E", timestamp: new Date(0) };
const fix = { fixType: "fix", numSat: 8, horDilution: 1, alt: 500, geoidalSep: 40 };
for (const type of ["geo-position", "fix"]) {
  const sentence = nmea.encode("GP", { type, ...fix, ...place });
  const { latitude, longitude } = parseNmeaSentence(sentence);
  console.log(sentence, "is read as", latitude.toFixed(4), longitude.toFixed(4));
}
END
node gll.cjs >seen

cat >expected <<'END'
$GPGLL,048.12,N,011.52,E,000000,A,D*7A is read as 0.8020 0.1920
$GPGGA,000000,048.12,N,011.52,E,1,8,1.0,500.0,M,40.0,M,,*42 is read as 0.8020 0.1920
END
diff expected seen || { echo "CHANGED: nmea-gll-is-degrees" >&2; exit 1; }
echo "PASS: 48.12 degrees are written as 48.12 minutes"
