#!/bin/sh
# SPDX-License-Identifier: MIT
# A range of infinity that foxglove-sdk logs as JSON makes a message that no JSON parser of JavaScript reads.
#
# Version:   foxglove-sdk 0.30.3 (Python), JSON.parse of Node.
# Expected:  JSON has no infinity, so the SDK writes null, or refuses the message when it is logged.
# Behaviour: It writes Infinity and NaN, which Python reads again and JSON.parse does not. The channel is declared as
#            json with a schema.
# Hurts:     Anyone who logs range finders: infinity means "no echo" in ROS, so just these messages are lost in the
#            viewer.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            foxglove-sdk==0.30.3 mcap==1.6.0 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >log.py <<'END'
import foxglove
from mcap.reader import make_reader

with foxglove.open_mcap("small.mcap"):
    foxglove.Channel("/range").log({"front": 1.5, "left": float("inf"), "rear": float("nan")}, log_time=1)
with open("small.mcap", "rb") as file:
    for schema, channel, message in make_reader(file).iter_messages():
        print(channel.message_encoding, schema.encoding, message.data.decode())
        open("message.json", "wb").write(message.data)
END
venv/bin/python log.py >seen
node -e 'try { JSON.parse(require("fs").readFileSync("message.json")) } catch (error) { console.log("node", error.name) }' >>seen

cat >expected <<'END'
json jsonschema {"front": 1.5, "left": Infinity, "rear": NaN}
node SyntaxError
END
diff expected seen || { echo "CHANGED: foxglove-infinite-range" >&2; exit 1; }
echo "PASS: the message has Infinity and NaN, and Node raises SyntaxError"
