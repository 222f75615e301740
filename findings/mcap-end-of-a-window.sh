#!/bin/sh
# SPDX-License-Identifier: MIT
# The end of a time window belongs to it in the JavaScript reader of MCAP and not in the Python one.
#
# Version:   mcap 1.6.0 (Python), @mcap/core 2.2.2 (Node).
# Expected:  Two readers of one project mean the same by a window from 10 to 20.
# Behaviour: Node returns the messages at 20, too; Python (end_time) leaves them out, and calls that option deprecated
#            in a warning.
# Hurts:     Anyone who cuts a recording into windows with one and counts with the other: messages on a border are
#            counted twice or never.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            mcap==1.6.0 || return 1
    npm install --silent --no-fund --no-audit --ignore-scripts \
        @mcap/core@2.2.2 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >window.py <<'END'
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

with open("small.mcap", "wb") as file:
    writer = Writer(file, compression=CompressionType.NONE)
    writer.start()
    channel = writer.register_channel("/range", "json", 0)
    for time in (10, 20, 20, 30):
        writer.add_message(channel, time, b"{}", time)
    writer.finish()
with open("small.mcap", "rb") as file:
    print("python", *(message.log_time for _, _, message in make_reader(file).iter_messages(start_time=10, end_time=20)))
END
cat >window.mjs <<'END'
import { readFileSync } from "node:fs";
import { McapIndexedReader } from "@mcap/core";

const data = readFileSync("small.mcap");
const readable = {
  size: async () => BigInt(data.length),
  read: async (offset, length) => new Uint8Array(data.subarray(Number(offset), Number(offset + length))),
};
const reader = await McapIndexedReader.Initialize({ readable });
const times = [];
for await (const message of reader.readMessages({ startTime: 10n, endTime: 20n })) times.push(Number(message.logTime));
console.log("node", ...times);
END
venv/bin/python -W ignore window.py >seen
node window.mjs >>seen

cat >expected <<'END'
python 10
node 10 20 20
END
diff expected seen || { echo "CHANGED: mcap-end-of-a-window" >&2; exit 1; }
echo "PASS: the window 10 to 20 has one message in Python and three in Node"
