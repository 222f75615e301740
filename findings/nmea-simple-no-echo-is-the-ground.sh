#!/bin/sh
# SPDX-License-Identifier: MIT
# An echo sounder without an echo is at a depth of 0 in nmea-simple: empty fields of any sentence are the number 0,
# and are sent on as 0.00.
#
# Version:   nmea-simple 3.3.0 (Node).
# Expected:  A field that is empty, as the format has it for what is not known, is undefined in the packet, as it is
#            when a packet is made.
# Behaviour: Reading turns an empty text into 0. Writing has an empty field for undefined, so a sentence that is read
#            and written again has got a depth, a position or a speed of zero.
# Hurts:     Anyone who alarms below a depth, or averages: lost bottom is ground, a receiver without a fix is in the
#            Gulf of Guinea.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    npm install --silent --no-fund --no-audit --ignore-scripts \
        nmea-simple@3.3.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >depth.cjs <<'END'
const { encodeNmeaPacket, parseNmeaSentence } = require("nmea-simple");

function complete(sentence) {
  const sum = [...sentence.slice(1)].reduce((total, letter) => total ^ letter.charCodeAt(0), 0);
  return `${sentence}*${sum.toString(16).toUpperCase().padStart(2, "0")}`;
}

for (const fields of ["$SDDBT,16.40,f,5.00,M,2.73,F", "$SDDBT,,f,,M,,F"]) {
  const packet = parseNmeaSentence(complete(fields));
  console.log(`${fields} -> ${packet.depthMeters} m -> ${encodeNmeaPacket(packet, "SD")}`);
}
console.log("made without a depth:", encodeNmeaPacket({ sentenceId: "DBT" }, "SD"));
const wind = parseNmeaSentence(complete("$WIMWV,,R,,N,V"));
console.log("no wind sensor: angle", wind.windAngle, "speed", wind.speed);
const fix = parseNmeaSentence(complete("$GPGGA,120000,,,,,0,00,,,M,,M,,"));
console.log("no fix: latitude", fix.latitude + 0, "longitude", fix.longitude + 0, "altitude", fix.altitudeMeters);
END
node depth.cjs >seen

cat >expected <<'END'
$SDDBT,16.40,f,5.00,M,2.73,F -> 5 m -> $SDDBT,16.40,f,5.00,M,2.73,F*06
$SDDBT,,f,,M,,F -> 0 m -> $SDDBT,0.00,f,0.00,M,0.00,F*36
made without a depth: $SDDBT,,f,,M,,F*28
no wind sensor: angle 0 speed 0
no fix: latitude 0 longitude 0 altitude 0
END
diff expected seen || { echo "CHANGED: nmea-simple-no-echo-is-the-ground" >&2; exit 1; }
echo "PASS: no echo is a depth of 0"
