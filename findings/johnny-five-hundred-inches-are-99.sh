#!/bin/sh
# SPDX-License-Identifier: MIT
# A MaxSonar that measures 100 inches is at 99.06 inches in johnny-five, which has 0.39 inches in a centimetre on the
# way back.
#
# Version:   johnny-five 2.1.0 (Node).
# Expected:  A sensor whose unit is the inch, with one inch for two counts, is read in inches as it sends them.
# Behaviour: The counts become centimetres by 2.54 and inches by 0.39, which is 1 % less than 1/2.54. All sensors have
#            it: an EV3 sonar at 2540 mm is at 99.06 inches, too.
# Hurts:     Anyone who compares inches with a tape, with another program or with a threshold at a step of the sensor:
#            254 inches, where the sensor says that nothing is there, are never reached.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    npm install --silent --no-fund --no-audit --ignore-scripts \
        johnny-five@2.1.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >inches.cjs <<'END'
const { EventEmitter } = require("events");
const five = require("johnny-five");

class Io extends EventEmitter {
  // A board whose inputs all have one value

  isReady = true;
  name = "none";
  MODES = { INPUT: 0, OUTPUT: 1, ANALOG: 2 };
  analogPins = [14, 15, 16, 17, 18, 19];
  pins = Array.from({ length: 20 }, (_, pin) => ({
    supportedModes: [0, 1, 2],
    analogChannel: pin < 14 ? 127 : pin - 14,
  }));

  pinMode() {}
  analogRead(pin, callback) {
    callback(this.value);
  }
}

const io = new Io();
const board = new five.Board({ io, repl: false, debug: false, sigint: false });
board.on("ready", () => {
  for (const inches of [6, 20, 100, 254]) {
    io.value = 2 * inches;
    const sonar = new five.Proximity({ controller: "MB1000", pin: "A0", board });
    console.log(`${inches} inches: ${sonar.cm} cm, ${sonar.inches} inches`);
  }
  process.exit(0);
});
END
node inches.cjs >seen

cat >expected <<'END'
6 inches: 15.24 cm, 5.94 inches
20 inches: 50.8 cm, 19.81 inches
100 inches: 254 cm, 99.06 inches
254 inches: 645.16 cm, 251.61 inches
END
diff expected seen || { echo "CHANGED: johnny-five-hundred-inches-are-99" >&2; exit 1; }
echo "PASS: 100 inches are 99.06"
