#!/bin/sh
# SPDX-License-Identifier: MIT
# Of several values that can-j1939 reads from a node's memory by DM14, only the first is there: 10, 20, 30 are read as
# 10, 0, 0.
#
# Version:   can-j1939 2.0.12, python-can 4.6.1.
# Expected:  read() with object_count=3 returns the three values, as return_raw_bytes=True returns the three bytes.
# Behaviour: Each slice begins one byte further and ends at the size of one object. The first is right, those of two or
#            four bytes lose their low bytes one by one, and an empty slice is the number 0.
# Hurts:     Anyone who reads calibrations or counters of a sensor over J1939: zeros look like counters that never
#            counted.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export TZ=UTC LC_ALL=C.UTF-8

setup() {
    python3 -m venv venv &&
        venv/bin/pip install -q --no-compile --disable-pip-version-check \
            can-j1939==2.0.12 \
            python-can==4.6.1 || return 1
}
setup >setup.log 2>&1 || { cat setup.log >&2; echo "NOT RUN: the packages cannot be had" >&2; exit 2; }

cat >memory.py <<'END'
from j1939 import Dm14Query, ParameterGroupNumber

PGN = ParameterGroupNumber.PGN


class Application:
    """A node with some memory, which answers at once."""

    def __init__(self, memory):
        self.memory, self.subscribers, self.answers = memory, [], []

    def subscribe(self, callback):
        self.subscribers.append(callback)

    def unsubscribe(self, callback):
        self.subscribers.remove(callback)

    def send_pgn(self, page, pdu_format, pdu_specific, priority, data):
        if data[1] >> 1 & 7 == 1:  # a request to read: proceed, the data, done
            self.answers = [
                (PGN.DM15, [data[0], 0x11, 0, 0, 0, 0, 0xFF, 0xFF]),
                (PGN.DM16, [len(self.memory), *self.memory]),
                (PGN.DM15, [0, 0x19, 0, 0, 0, 0, 0xFF, 0xFF]),
            ]


class Query(Dm14Query):
    """Deliver the answers where the original waits for them."""

    def __init__(self, application):
        super().__init__(application)
        original = self.data_queue.get

        def get(**options):
            for pgn, data in application.answers:
                for callback in list(application.subscribers):
                    callback(6, pgn, 0x80, 0.0, data)
            return original(**options)

        self.data_queue.get = get


def read(memory, **options):
    return Query(Application(memory)).read(0x80, 1, 0x1000, **options)


print("bytes 10, 20, 30:", read([10, 20, 30], object_count=3))
print("as raw bytes:", read([10, 20, 30], object_count=3, return_raw_bytes=True))
words = [byte for word in (1000, 2000, 3000) for byte in word.to_bytes(2, "little")]
print("words 1000, 2000, 3000:", read(words, object_count=3, object_byte_size=2))
END
venv/bin/python memory.py >seen

cat >expected <<'END'
bytes 10, 20, 30: [10, 0, 0]
as raw bytes: [10, 20, 30]
words 1000, 2000, 3000: [1000, 3, 0]
END
diff expected seen || { echo "CHANGED: can-j1939-one-value-and-zeros" >&2; exit 1; }
echo "PASS: 10, 20, 30 are read as 10, 0, 0"
