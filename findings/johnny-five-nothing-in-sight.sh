#!/bin/sh
# SPDX-License-Identifier: MIT
# With nothing in sight the sensors of johnny-five are at -346, 0, 7330491 or Infinity cm: some free ways are nearer
# than every obstacle.
#
# Version:   johnny-five 2.1.0 (Node).
# Expected:  A class for proximity sensors of all kinds reports one thing where there is no echo, or at least nothing
#            below zero.
# Behaviour: The formula of each sensor is used for all voltages. That of the GP2Y0A41SK0F is negative below its pole
#            and infinite at it; sonars and the laser have 0, which their boards send on a time-out.
# Hurts:     Anyone who stops at cm < 30: a robot with that sensor or with an HC-SR04 stops in an empty hall, one with
#            a GP2Y0A21YK does not. within() with a range from 0 on hides the one and not the other.
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

cat >nothing.cjs <<'END'
const { EventEmitter } = require("events");
const five = require("johnny-five");

class Io extends EventEmitter {
  // A board whose inputs all have one value

  isReady = true;
  name = "none";
  MODES = { INPUT: 0, OUTPUT: 1, ANALOG: 2 };
  HIGH = 1;
  LOW = 0;
  analogPins = [14, 15, 16, 17, 18, 19];
  pins = Array.from({ length: 20 }, (_, pin) => ({
    supportedModes: [0, 1, 2],
    analogChannel: pin < 14 ? 127 : pin - 14,
  }));

  pinMode() {}
  i2cConfig() {}
  i2cWrite() {}
  i2cReadOnce(address, register, count, callback) {
    callback([this.value >> 8, this.value & 255]);
  }
  analogRead(pin, callback) {
    callback(this.value);
  }
  pingRead(settings, callback) {
    callback(this.value);
  }
}

const io = new Io();
const board = new five.Board({ io, repl: false, debug: false, sigint: false });
board.on("ready", () => {
  for (const [controller, values] of [
    ["GP2Y0A41SK0F", [200, 12, 11, 5, 0]],
    ["GP2Y0A21YK", [200, 5, 0]],
    ["GP2Y0A710K0F", [400, 5, 0]],
    ["GP2Y0A02YK0F", [200, 0]],
    ["HCSR04", [2910, 0]],
  ]) {
    const seen = values.map((value) => {
      io.value = value;
      return `${value} is ${new five.Proximity({ controller, pin: "A0", board }).cm}`;
    });
    console.log(`${controller}: ${seen.join(", ")}`);
  }
  process.exit(0);
});
END
node nothing.cjs >seen

cat >expected <<'END'
GP2Y0A41SK0F: 200 is 10.98, 12 is 2076, 11 is Infinity, 5 is -346, 0 is -188.73
GP2Y0A21YK: 200 is 27.88, 5 is 1939.26, 0 is Infinity
GP2Y0A710K0F: 400 is 150, 5 is 7330491, 0 is Infinity
GP2Y0A02YK0F: 200 is 65.14, 0 is Infinity
HCSR04: 2910 is 50, 0 is 0
END
diff expected seen || { echo "CHANGED: johnny-five-nothing-in-sight" >&2; exit 1; }
echo "PASS: nothing is at -346, 0, 7330491 and Infinity cm"
